#include "service/documents/comparison_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const ComparisonDocument& document) { return written(document); }

ComparisonDocument read_comparison(std::string_view text) {
  return document_from<ComparisonDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
