#pragma once

#include <optional>
#include <string>
#include <variant>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "cs8_protocol/messages.hpp"

namespace cell {

/// A touch that a person made with the pendant.
struct HandTouch {
  cs8::JointsMicrodeg wire_joints{};  // of the state in which the probe read touched first
  calib::JointVector joints = calib::JointVector::Zero();
  /// The nominal ball's way since the state before, in which the trigger was; nothing when it was taken by
  /// word, with nobody knowing where the probe tripped.
  std::optional<double> moved_m;
};

/// Watches the controller's states for a probe that trips while a person jogs. A value without a clock.
class HandTouchWatch {
 public:
  explicit HandTouchWatch(const calib::KinematicModel& nominal) : prepared_(calib::prepare(nominal)) {}

  /// The next state; a touch when the probe was free before and reads touched now, and the joints are
  /// referenced.
  std::optional<HandTouch> on_controller_state(const cs8::State& state);
  /// Where the arm stands now, by a person's word; or why that is no touch: the probe does not read touched,
  /// the arm moves, nothing was heard, or this contact was given out before. A contact is one touch: the
  /// probe must be free before the next.
  std::variant<HandTouch, std::string> take();

 private:
  calib::PreparedModel prepared_;
  std::optional<cs8::State> last_;
  std::optional<Eigen::Vector3d> free_m_;  // the ball when the probe was last free
  bool given_ = false;                     // the contact under way
};

}  // namespace cell
