#include "service/documents/tool_document.hpp"

#include "service/documents/document_error.hpp"
#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const ToolDocument& document) { return written(document); }

ToolDocument read_tool(std::string_view text) {
  auto document = document_from<ToolDocument>(text, Absent::kIsRefused);
  const ToolDocument named;
  if (document.schema != named.schema)
    throw DocumentError("/schema", "must be '" + named.schema + "', not '" + document.schema + "'");
  return document;
}

}  // namespace cell
