#include "service/acquisition/hand_touch.hpp"

#include "service/acquisition/touch_command.hpp"

namespace cell {

std::optional<HandTouch> HandTouchWatch::hear(const cs8::State& state) {
  const cs8::ProbeInputs probe = cs8::probe_inputs(state.flags);
  const calib::JointVector joints = from_wire(state.joints);
  const Eigen::Vector3d ball_m = calib::forward_chain(prepared_, joints).tip_in_block_m();
  last_ = state;
  if (probe.free()) {
    free_m_ = ball_m;
    return std::nullopt;
  }
  if (!probe.touched() || !free_m_) return std::nullopt;  // its two inputs may change one after the other
  const double moved_m = (ball_m - *free_m_).norm();
  free_m_.reset();
  return HandTouch{state.joints, joints, moved_m};
}

std::variant<HandTouch, std::string> HandTouchWatch::take() const {
  if (!last_) return "the controller has not told where the arm is";
  if (cs8::probe_inputs(last_->flags).free()) return "the probe reads free: jog until it touches";
  if ((last_->flags & cs8::kSettled) == 0) return "the arm moves: stop it first";
  return HandTouch{last_->joints, from_wire(last_->joints), std::nullopt};
}

}  // namespace cell
