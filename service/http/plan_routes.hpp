#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "service/http/routes.hpp"

namespace cell {

/// POST plan: the plan of a recipe that has been planned (see recipe_to_plan), touchcal/plan/1; 422 with what
/// was tried when there is none.
HttpResponse post_plan(const HttpRequest& request, const CellOperation& operation);

/// The recipe that has to be planned (CellOperation::plan_recipe, seconds) before a POST plan can be
/// answered; nothing when the body does not name one of this cell, or it has been planned.
std::optional<std::string> recipe_to_plan(const HttpRequest& request, const CellOperation& operation);

/// GET runs/{id}/plan of a run that is in the store: the plan it follows; 409 before it is made.
HttpResponse get_plan(const CellOperation& operation, std::int64_t id);

}  // namespace cell
