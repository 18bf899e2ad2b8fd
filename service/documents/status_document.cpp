#include "service/documents/status_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const StatusDocument& document) { return written(document); }

std::string members_text(const LiveFields& fields) {
  const std::string object = written(fields);
  return object.substr(1, object.size() - 2);
}

StatusDocument read_status(std::string_view text) {
  return document_from<StatusDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
