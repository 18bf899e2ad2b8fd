#pragma once

#include <variant>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

/// Reads the body of POST runs: a recipe, or a plan of one; optionally the operator and who makes the
/// touches.
std::variant<StartRequest, Problem> read_start(const HttpRequest& request, const CellOperation& operation);

}  // namespace cell
