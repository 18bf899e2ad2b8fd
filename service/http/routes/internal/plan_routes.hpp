#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "service/http/routes/reads.hpp"
#include "service/http/routes/routes.hpp"

namespace cell {

/// The recipe that must be planned (CellOperation::plan_recipe, seconds) before a POST plan can be answered;
/// nothing if it has been planned or the body names none of this cell. On the operation's thread.
std::optional<std::string> recipe_to_plan(const HttpRequest& request, const CellOperation& operation);

/// GET runs/{id}/plan of a run that is in the store: the plan it follows; 409 before it is made.
HttpResponse get_plan(const Reads& reads, std::int64_t id);

}  // namespace cell
