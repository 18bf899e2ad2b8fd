#pragma once

#include "cs8_protocol/messages.hpp"
#include "sim_controller/controller_state.hpp"

namespace sim {

/// What the controller says about itself. `open_sequence` is a command that runs or whose result waits.
cs8::Welcome welcome(const Plant& plant, const ControllerState& state, std::uint32_t open_sequence,
                     TimePoint now);
cs8::State state_report(const ControllerState& state, TimePoint now);

/// The result of a command that has ended, with its sequence; the arm is at standstill.
cs8::Message result(const ControllerState& state, const RunningCommand& ended);

}  // namespace sim
