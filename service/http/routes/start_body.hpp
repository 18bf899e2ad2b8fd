#pragma once

#include <variant>

#include "service/acquisition/operation.hpp"
#include "service/http/server/problem.hpp"

namespace cell {

/// What the body of POST runs asks for: a recipe, itself or by a plan; who asks and how warm the block is
/// where that is told. Else what is wrong with it.
std::variant<StartRequest, Problem> read_start(const HttpRequest& request, const Operation& operation);

}  // namespace cell
