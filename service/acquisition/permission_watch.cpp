#include "service/acquisition/permission_watch.hpp"

#include <spdlog/fmt/fmt.h>

#include "cs8_protocol/names.hpp"

namespace cell {

std::string lost_permission(const cs8::State& state) {
  std::string lost;
  const auto add_if = [&lost](bool is_lost, std::string_view words) {
    if (is_lost) lost.append(lost.empty() ? "" : ", ").append(words);
  };
  add_if(state.emergency_stop != 0, "an emergency stop");
  add_if((state.flags & cs8::kCellClosed) == 0, "an open cell");
  add_if((state.flags & cs8::kPowered) == 0, "no power");
  add_if((state.flags & cs8::kHeld) != 0, "hold");
  add_if((state.flags & cs8::kArmCalibrated) == 0, "no joint references");
  // Asked with each State: no text is made unless it is told.
  if (state.mode != cs8::WorkingMode::kRemote)
    add_if(true, fmt::format("the mode '{}'", cs8::name(state.mode)));
  if (state.permit != cs8::PermitState::kGranted)
    add_if(true, fmt::format("the permit '{}'", cs8::name(state.permit)));
  return lost.empty() ? lost : "the controller tells " + lost;
}

void PermissionWatch::on_state(const cs8::State& state, TimePoint now) {
  heartbeats_without_state_ = 0;
  lost_ = lost_permission(state);
  if (lost_.empty()) {
    lost_count_ = 0;
  } else if (++lost_count_ == 1) {
    lost_since_ = now;
  }
}

std::optional<Fault> PermissionWatch::fault(TimePoint now) const {
  if (heartbeats_without_state_ >= kSilentHeartbeatsMax) return Fault{FaultCode::kStateMissing, {}};
  if (lost_count_ > 1 && now - lost_since_ >= kAnswerPatience)
    return Fault{FaultCode::kPermissionLost, lost_};
  return std::nullopt;
}

}  // namespace cell
