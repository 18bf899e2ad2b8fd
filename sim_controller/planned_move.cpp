#include "sim_controller/planned_move.hpp"

#include <algorithm>
#include <utility>

namespace sim {
namespace {

/// A share below this would never come to an end.
constexpr double kShareMin = 1e-4;
/// A connection move's fastest joint, and its acceleration.
constexpr double kConnectionRadiansPerSecond = 0.2;
constexpr double kConnectionRadiansPerSecond2 = 0.5;
/// A move without length takes its tick or two all the same.
constexpr double kRateMax = 1.0 / kTickSeconds;
constexpr double kRampMax = 1.0 / (kTickSeconds * kTickSeconds);

}  // namespace

MotionDescriptor at_tip_speed(double tip_speed_m_s) {
  return {.tip_speed_m_s = tip_speed_m_s, .tip_acceleration_m_s2 = kAccelerationMetresPerSecond2};
}

Move plan_move(const Plant& plant, Stretch stretch, const MotionDescriptor& how,
               const Eigen::Isometry3d& tip_from_tool) {
  const PathSlope slope = path_slope(plant, stretch, tip_from_tool);
  const auto ramp = [&slope](double tip_m_s2, double share) {
    return std::min({kRampMax, tip_m_s2 / slope.tip_m,
                     std::max(share, kShareMin) / (slope.joint_seconds * kJointRampSeconds)});
  };
  Move move;
  move.path = std::make_shared<const Path>(std::move(stretch.path));
  move.from = stretch.from;
  move.to = stretch.to;
  move.top_rate = std::min({kRateMax, how.tip_speed_m_s / slope.tip_m, how.turn_speed_rad_s / slope.turn_rad,
                            std::max(how.joint_speed_share, kShareMin) / slope.joint_seconds});
  move.manual_rate =
      std::min(kManualTipMetresPerSecond / slope.tip_m, kManualJointRadiansPerSecond / slope.joint_rad);
  move.acceleration = ramp(how.tip_acceleration_m_s2, how.joint_acceleration_share);
  move.deceleration = ramp(how.tip_acceleration_m_s2, how.joint_deceleration_share);
  const double harder = kResetDecelerationMetresPerSecond2 / kAccelerationMetresPerSecond2;
  move.reset_deceleration = std::max(
      {move.deceleration, harder * ramp(kAccelerationMetresPerSecond2, 1.0), move.top_rate / kResetSeconds});
  return move;
}

Move impossible_move(const calib::JointVector& at, std::string why) {
  Move move;
  move.why_impossible = std::move(why);
  move.path = std::make_shared<const Path>(Path{at, at});
  move.is_impossible = true;
  return move;
}

Move connection_move(const calib::JointVector& from, const calib::JointVector& to) {
  const double way_rad = (to - from).cwiseAbs().maxCoeff();
  Move move;
  move.path = std::make_shared<const Path>(Path{from, to});
  move.top_rate = std::min(kRateMax, kConnectionRadiansPerSecond / way_rad);
  move.acceleration = std::min(kRampMax, kConnectionRadiansPerSecond2 / way_rad);
  move.deceleration = move.acceleration;
  move.reset_deceleration = std::max(move.deceleration, move.top_rate / kResetSeconds);
  move.is_connection = true;
  return move;
}

}  // namespace sim
