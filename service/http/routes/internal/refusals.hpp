#pragma once

#include "service/http/server/problem.hpp"

namespace cell {

class CellOperation;
struct CommandRefusal;

/// A refused command as a problem document with the commands that the state allows.
HttpResponse refusal_response(const CommandRefusal& refusal, const CellOperation& operation);

}  // namespace cell
