#pragma once

#include <vector>

#include "service/http/server/problem.hpp"
#include "service/run/packml_state.hpp"

namespace cell {

struct CommandRefusal;

/// A refused command as a problem document. `exits`: the commands that the state allows.
HttpResponse refusal_response(const CommandRefusal& refusal, const std::vector<Command>& exits);

/// Of a command that cannot be written into the audit.
Problem not_recorded();

}  // namespace cell
