#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "service/http/routes/routes.hpp"

namespace cell {

/// POST plan: touchcal/plan/1 of a recipe that has been planned (see recipe_to_plan); 422 with what was tried
/// if there is no plan.
HttpResponse post_plan(const HttpRequest& request, const CellOperation& operation);

/// The recipe that must be planned (CellOperation::plan_recipe, seconds) before a POST plan can be answered;
/// nothing if it has been planned or the body names none of this cell.
std::optional<std::string> recipe_to_plan(const HttpRequest& request, const CellOperation& operation);

/// GET runs/{id}/plan of a run that is in the store: the plan it follows; 409 before it is made.
HttpResponse get_plan(const CellOperation& operation, std::int64_t id);

}  // namespace cell
