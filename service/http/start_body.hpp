#pragma once

#include <variant>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/routes.hpp"

namespace cell {

/// What the body of POST runs asks for: a recipe, itself or by a plan; who asks and how warm the block is
/// where that is told. Else what is wrong with it.
std::variant<StartRequest, Problem> read_start(const HttpRequest& request, const CellOperation& operation);

}  // namespace cell
