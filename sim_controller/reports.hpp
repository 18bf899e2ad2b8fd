#pragma once

#include <optional>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/controller.hpp"

namespace sim {

/// How a motion command ended.
struct Ending {
  cs8::Outcome outcome{};
  cs8::Phase phase{};
  std::optional<Capture> capture;  // where the probe tripped in the search
};

/// What the controller says about itself. `open_sequence` is a command that runs or whose result waits.
cs8::Welcome welcome(const Plant& plant, const ControllerState& state, std::uint32_t open_sequence,
                     TimePoint now);
cs8::State state_report(const Plant& plant, const ControllerState& state, const Place& place, TimePoint now);

/// Results of a command that has ended; the arm stands at `state.joints`.
cs8::TouchResult touch_result(const ControllerState& state, const RunningCommand& command,
                              const Ending& ending);
cs8::MoveResult move_result(const ControllerState& state, const RunningCommand& command,
                            const Ending& ending);

}  // namespace sim
