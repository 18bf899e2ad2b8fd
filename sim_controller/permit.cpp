#include "sim_controller/permit.hpp"

#include <algorithm>

namespace sim {
namespace {

using cs8::PermitReason;
using cs8::PermitState;

cs8::Permit change(PermitHolder& holder, PermitState state, PermitReason reason, std::int32_t detail = 0) {
  holder.permit.state = state;
  holder.permit.reason = reason;
  holder.permit.detail = detail;
  return holder.permit;
}

bool breaks_off(cs8::Outcome outcome) {
  switch (outcome) {
    case cs8::Outcome::kUnexpectedContact:
    case cs8::Outcome::kStopped:
    case cs8::Outcome::kCollision:
    case cs8::Outcome::kMotionError:
    case cs8::Outcome::kDeadline:
    case cs8::Outcome::kTaskFailed:
      return true;
    case cs8::Outcome::kContact:
    case cs8::Outcome::kNoContact:
    case cs8::Outcome::kArrived:
    case cs8::Outcome::kProbeStuck:
    case cs8::Outcome::kHeartbeatLost:
    case cs8::Outcome::kPermissionLost:
    case cs8::Outcome::kOvertravel:
    case cs8::Outcome::kProbeFault:
      return false;
  }
  return false;
}

}  // namespace

cs8::Permit await(PermitHolder& holder, const cs8::Begin& begin, TimePoint now) {
  holder.permit.run = begin.run;
  const std::uint32_t within = std::clamp(begin.confirm_within_ms, kConfirmWithinMinMs, kConfirmWithinMaxMs);
  holder.confirm_by = now + std::chrono::milliseconds(within);
  holder.key_ready = false;
  return change(holder, PermitState::kAwaited, PermitReason::kNone);
}

cs8::Permit refuse(PermitHolder& holder, const cs8::Begin& begin, cs8::RejectReason reason) {
  holder.permit.run = begin.run;
  return change(holder, PermitState::kNone, PermitReason::kRefused, static_cast<std::int32_t>(reason));
}

std::optional<cs8::Permit> watch_key(PermitHolder& holder, bool key_is_on) {
  holder.key_on_ticks = key_is_on ? std::min(holder.key_on_ticks + 1, kSteadyTicks) : 0;
  holder.key_off_ticks = key_is_on ? 0 : std::min(holder.key_off_ticks + 1, kSteadyTicks);
  if (holder.permit.state != PermitState::kAwaited) return std::nullopt;
  holder.key_ready = holder.key_ready || holder.key_off_ticks == kSteadyTicks;
  if (!holder.key_ready || holder.key_on_ticks < kSteadyTicks) return std::nullopt;
  return change(holder, PermitState::kGranted, PermitReason::kNone);
}

std::optional<cs8::Permit> expire(PermitHolder& holder, TimePoint now) {
  if (holder.permit.state != PermitState::kAwaited || now < holder.confirm_by) return std::nullopt;
  return change(holder, PermitState::kNone, PermitReason::kNotConfirmed);
}

std::optional<cs8::Permit> withdraw(PermitHolder& holder, cs8::PermitReason reason) {
  if (holder.permit.state == PermitState::kNone) return std::nullopt;
  return change(holder, PermitState::kNone, reason);
}

std::optional<cs8::Permit> after_command(PermitHolder& holder, cs8::Outcome outcome, bool retract_due) {
  if (holder.permit.state == PermitState::kRetractOnly) return withdraw(holder, PermitReason::kBrokenOff);
  if (holder.permit.state != PermitState::kGranted || !breaks_off(outcome)) return std::nullopt;
  return change(holder, retract_due ? PermitState::kRetractOnly : PermitState::kNone,
                PermitReason::kBrokenOff);
}

}  // namespace sim
