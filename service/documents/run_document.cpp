#include "service/documents/run_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const RunDocument& document) { return written(document); }
std::string document_text(const RunsDocument& document) { return written(document); }
std::string document_text(const StartDocument& document) { return written(document); }

RunDocument read_run(std::string_view text) { return document_from<RunDocument>(text, Absent::kIsRefused); }

RunsDocument read_runs(std::string_view text) {
  return document_from<RunsDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
