#include "service/documents/checks_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const ChecksDocument& document) { return written(document); }

ChecksDocument read_checks(std::string_view text) {
  return document_from<ChecksDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
