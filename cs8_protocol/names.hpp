#pragma once

#include <string_view>

#include "cs8_protocol/messages.hpp"

/// The name of each listed value, as PROTOCOL.md writes it ("kProbeStuck" is "probe_stuck"). Empty for a
/// value that is not in the list: the codec takes exactly the values that have a name.
namespace cs8 {

std::string_view name(MessageType type);
std::string_view name(RejectReason reason);
std::string_view name(Outcome outcome);
std::string_view name(Phase phase);
std::string_view name(CaptureSource source);
std::string_view name(WorkingMode mode);
std::string_view name(FaultCode code);
std::string_view name(PermitState state);
std::string_view name(PermitReason reason);

}  // namespace cs8
