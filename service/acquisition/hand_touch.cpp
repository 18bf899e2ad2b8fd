#include "service/acquisition/hand_touch.hpp"

#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

std::optional<double> own_noise_um(const HandTouch& touch, double declared_noise_m) {
  if (!touch.moved_m || !(declared_noise_m > 0.0)) return std::nullopt;
  constexpr double kStepsPerUm = 10.0;
  const double deviation_m = std::hypot(declared_noise_m, *touch.moved_m / std::sqrt(3.0));
  const double noise_um = std::round(kStepsPerUm * calib::um_from_metres(deviation_m)) / kStepsPerUm;
  if (calib::metres_from_um(noise_um) <= declared_noise_m) return std::nullopt;
  return noise_um;
}

std::optional<HandTouch> HandTouchWatch::on_controller_state(const cs8::State& state) {
  const cs8::ProbeInputs probe = cs8::probe_inputs(state.flags);
  const calib::JointVector joints = from_wire(state.joints);
  const Eigen::Vector3d ball_m = calib::forward_chain(prepared_, joints).tip_in_block_m();
  last_ = state;
  if (probe.free()) {
    free_m_ = ball_m;
    given_ = false;
    return std::nullopt;
  }
  const bool referenced = (state.flags & cs8::kArmCalibrated) != 0;
  // Its two inputs may change one after the other.
  if (!probe.touched() || !referenced || !free_m_) return std::nullopt;
  const double moved_m = (ball_m - *free_m_).norm();
  free_m_.reset();
  given_ = true;
  return HandTouch{state.joints, joints, moved_m};
}

namespace {

/// Why no position can be taken in this state, whoever says that it is a contact; nothing when it can.
std::optional<std::string> why_no_position(const std::optional<cs8::State>& last) {
  if (!last) return "the controller has not reported the arm's position";
  if ((last->flags & cs8::kArmCalibrated) == 0)
    return "the joints are not referenced: reference the arm first";
  if ((last->flags & cs8::kSettled) == 0) return "the arm moves: stop it first";
  return std::nullopt;
}

}  // namespace

std::variant<HandTouch, std::string> HandTouchWatch::take_by_word() const {
  if (const auto why = why_no_position(last_)) return *why;
  return HandTouch{last_->joints, from_wire(last_->joints), std::nullopt};
}

std::variant<HandTouch, std::string> HandTouchWatch::take() {
  if (!last_) return *why_no_position(last_);
  const cs8::ProbeInputs probe = cs8::probe_inputs(last_->flags);
  if (probe.free()) return "the probe reads free: jog until it touches";
  if (!probe.touched()) return "the probe's two inputs contradict each other: look at its cable";
  if (const auto why = why_no_position(last_)) return *why;
  if (given_)
    return "this contact was taken or refused already: jog back until the probe is free, then touch again";
  given_ = true;
  return HandTouch{last_->joints, from_wire(last_->joints), std::nullopt};
}

}  // namespace cell
