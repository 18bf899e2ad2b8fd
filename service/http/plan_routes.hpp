#pragma once

#include <cstdint>

#include "service/http/routes.hpp"

namespace cell {

/// POST plan: the plan of a recipe that has been planned (see recipe_to_plan), touchcal/plan/1; 422 with what
/// was tried when there is none, 503 while another one is being made.
HttpResponse post_plan(const HttpRequest& request, const Operation& operation);

/// GET runs/{id}/plan of a run that is in the store: the plan it follows; 409 before it is made.
HttpResponse get_plan(const Operation& operation, std::int64_t id);

}  // namespace cell
