#include "service/documents/qualification_document.hpp"

#include "service/documents/document_error.hpp"
#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const QualificationDocument& document) { return written(document); }

QualificationDocument read_qualification(std::string_view text) {
  auto document = document_from<QualificationDocument>(text, Absent::kIsRefused);
  const QualificationDocument named;
  if (document.schema != named.schema)
    throw DocumentError("/schema", "must be '" + named.schema + "', not '" + document.schema + "'");
  return document;
}

}  // namespace cell
