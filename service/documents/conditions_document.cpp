#include "service/documents/conditions_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const ConditionsDocument& document) { return written(document); }

ConditionsDocument read_conditions(std::string_view text) {
  return document_from<ConditionsDocument>(text, Absent::kKeepsDefault);
}

std::optional<std::string> touching_of(std::string_view conditions) {
  try {
    return read_conditions(conditions).touch_mode;
  } catch (const DocumentError&) {
    return std::nullopt;
  }
}

}  // namespace cell
