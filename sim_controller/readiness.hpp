#pragma once

#include <optional>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"

namespace sim {

/// What the cabinet has against any motion: task, emergency stop, mode, power, hold, references, monitor
/// speed, open cell; the first that applies.
std::optional<cs8::Rejected> cabinet_refusal(const Cabinet& cabinet);

/// What the probe has against a motion that is not a retract: inputs that disagree, a stylus that touches.
std::optional<cs8::Rejected> probe_refusal(const Cabinet& cabinet);

}  // namespace sim
