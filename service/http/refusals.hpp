#pragma once

#include "service/http/routes.hpp"

namespace cell {

struct CommandRefusal;

/// A command that was not taken, as a problem document with the commands that the state allows.
HttpResponse from_refusal(const CommandRefusal& refusal, const CellOperation& operation);

}  // namespace cell
