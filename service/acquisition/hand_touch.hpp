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
  /// The nominal ball's motion since the previous state, within which the probe tripped; empty for a touch
  /// taken by command, where that is unknown.
  std::optional<double> moved_m;
};

/// Standard deviation of such a touch along the normal, micrometres to a tenth, where it is more than that of
/// a touch whose joints were latched: `declared_noise_m`. Nothing where it is not, or one of both is unknown
/// (0). The probe tripped anywhere between the two readings, with equal probability on all of the way, and
/// the later reading counts: its error is moved / sqrt(3) rms, independent of the noise of a trip.
std::optional<double> own_noise_um(const HandTouch& touch, double declared_noise_m);

/// Watches the controller's states for a probe that trips while a person jogs. Reads no clock.
class HandTouchWatch {
 public:
  explicit HandTouchWatch(const calib::KinematicModel& nominal) : prepared_(calib::prepare(nominal)) {}

  /// Takes the next state; returns a touch when the probe was free before and reads touched now, with
  /// referenced joints.
  std::optional<HandTouch> on_controller_state(const cs8::State& state);
  /// Takes the present position as a touch, on a person's command; or says why it is not one: the probe does
  /// not read touched, the arm moves, no state was received, or this contact was returned before. The probe
  /// must be free between two touches.
  std::variant<HandTouch, std::string> take();
  /// The same whatever the probe's inputs read: of a tip that trips nothing only the person knows that it
  /// touches.
  [[nodiscard]] std::variant<HandTouch, std::string> take_by_word() const;

 private:
  calib::PreparedModel prepared_;
  std::optional<cs8::State> last_;
  std::optional<Eigen::Vector3d> free_m_;  // the ball when the probe was last free
  bool given_ = false;                     // the present contact was returned
};

}  // namespace cell
