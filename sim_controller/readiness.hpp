#pragma once

#include <optional>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/cabinet.hpp"

namespace sim {

struct ControllerState;

/// What the cabinet has against any motion: task, emergency stop, mode, power, hold, references, monitor
/// speed, open cell; the first that applies.
std::optional<cs8::Rejected> cabinet_refusal(const Cabinet& cabinet);

/// What the probe has against a motion that is not a retract: inputs that disagree, a stylus that touches.
std::optional<cs8::Rejected> probe_refusal(const Cabinet& cabinet);

/// What is against a person's confirmation being waited for; the first that applies.
std::optional<cs8::RejectReason> refusal_of_begin(const ControllerState& state);

/// What is against a motion command of this number, before its fields are looked at.
std::optional<cs8::Rejected> refusal_of_motion(const ControllerState& state, std::uint32_t sequence,
                                               bool is_retract);

}  // namespace sim
