#include "service/documents/plan_document.hpp"

#include "service/documents/internal/document_fields.hpp"

namespace cell {

std::string document_text(const PlanDocument& document) { return written(document); }

PlanDocument read_plan(std::string_view text) {
  return document_from<PlanDocument>(text, Absent::kIsRefused);
}

}  // namespace cell
