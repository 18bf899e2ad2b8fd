#include "service/documents/validation_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const ValidationDocument& document) { return written(document); }

ValidationDocument read_validation(std::string_view text) {
  return document_from<ValidationDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
