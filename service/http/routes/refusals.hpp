#pragma once

#include "service/http/server/problem.hpp"

namespace cell {

class Operation;
struct Refusal;

/// A command that was not taken, as a problem document with the commands that the state allows.
HttpResponse from_refusal(const Refusal& refusal, const Operation& operation);

}  // namespace cell
