#include "service/documents/verification_report.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const VerificationReport& report) { return written(report); }

/// The conditions in it may be those of an older daemon.
VerificationReport read_verification_report(std::string_view text) {
  return document_from<VerificationReport>(text, Absent::kKeepsDefault);
}

}  // namespace cell
