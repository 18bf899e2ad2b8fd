#include "service/documents/run_report.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const RunReport& report) { return written(report); }

/// The result in it may be one that an older daemon stored.
RunReport read_report(std::string_view text) { return document_from<RunReport>(text, Absent::kKeepsDefault); }

}  // namespace cell
