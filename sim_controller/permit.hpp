#pragma once

#include <optional>

#include "cs8_protocol/messages.hpp"
#include "sim_controller/motion_task.hpp"

/// Whether motion commands are taken: PROTOCOL.md section 7.
namespace sim {

/// The time for a confirmation that a host asks for is brought into this range.
inline constexpr std::uint32_t kConfirmWithinMinMs = 1'000;
inline constexpr std::uint32_t kConfirmWithinMaxMs = 30'000;

struct PermitHolder {
  cs8::Permit permit;  // as last reported
  TimePoint confirm_by{};
  int key_off_ticks = kSteadyTicks;  // how long the confirmation key has been so
  int key_on_ticks = 0;
  bool key_ready = false;  // it was off since Begin
};

/// Accepts Begin: the key is watched from now on. Returns the permit to report to the host.
cs8::Permit await(PermitHolder& holder, const cs8::Begin& begin, TimePoint now);
cs8::Permit refuse(PermitHolder& holder, const cs8::Begin& begin, cs8::RejectReason reason);

/// The key, once a tick; granted when it goes from off to on, each for 20 ms.
std::optional<cs8::Permit> watch_key(PermitHolder& holder, bool key_is_on);
/// The time for the confirmation is over.
std::optional<cs8::Permit> expire(PermitHolder& holder, TimePoint now);
/// Takes it away, if there is one.
std::optional<cs8::Permit> withdraw(PermitHolder& holder, cs8::PermitReason reason);
/// After a command: one that was broken off leaves the way back at most.
std::optional<cs8::Permit> after_command(PermitHolder& holder, cs8::Outcome outcome, bool retract_due);

}  // namespace sim
