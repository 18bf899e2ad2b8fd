#pragma once

#include <string>
#include <variant>

#include "service/acquisition/cell_operation.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

/// Reads the body of POST runs: a recipe, or a plan of one; optionally the operator, who makes the touches,
/// whether the compliance is estimated and the block's temperature, measured now unless it says when. The age
/// of that is a precondition.
std::variant<StartRequest, Problem> read_start(const HttpRequest& request, const CellOperation& operation);

/// The operator whom the body of POST runs names; empty where it names nobody or cannot be read. On any
/// thread.
std::string operator_of_start(const HttpRequest& request);

}  // namespace cell
