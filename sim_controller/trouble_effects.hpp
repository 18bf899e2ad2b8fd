#pragma once

#include "sim_controller/controller_state.hpp"
#include "sim_controller/troubles.hpp"

namespace sim {

/// A trouble of the probe or of the cabinet, whatever program runs on it; between two ticks. False when the
/// trouble is one of the program or its people.
bool apply(const Trouble& trouble, Cabinet& cabinet);

/// Any trouble of the C++ twin, between two ticks. Of a restart only what the application forgets: its
/// connection is the caller's.
void apply(const Trouble& trouble, ControllerState& state);

}  // namespace sim
