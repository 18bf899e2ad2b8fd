#include "service/documents/conditions_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const ConditionsDocument& document) { return written(document); }

std::optional<std::string> touching_of(std::string_view conditions) {
  try {
    return document_from<ConditionsDocument>(conditions, Absent::kKeepsDefault).touch_mode;
  } catch (const DocumentError&) {
    return std::nullopt;
  }
}

}  // namespace cell
