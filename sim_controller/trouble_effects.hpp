#pragma once

#include "sim_controller/controller_state.hpp"
#include "sim_controller/troubles.hpp"

namespace sim {

/// Between two ticks. Of a restart only what the application forgets: its connection is the caller's.
void apply(const Trouble& trouble, ControllerState& state);

}  // namespace sim
