#include "calib_core/kinematics/tool_frame.hpp"

#include <algorithm>
#include <cmath>

namespace calib {
namespace {

/// A tool's point this near to its own z axis, metres, lies on it.
constexpr double kOnAxisMetres = 1e-9;
/// Cosine of a beta this near to a quarter turn.
constexpr double kQuarterTurnCosine = 1e-9;

}  // namespace

void mount_tool(KinematicModel& model, const Eigen::Isometry3d& frame6_from_tool) {
  const Eigen::Vector3d point_m = frame6_from_tool.translation();
  const Eigen::Vector3d z = frame6_from_tool.linear().col(2);
  // Frame 7 leaves R_6 by d along an x and by r along z, so that the point has no part along its y.
  Eigen::Vector3d y = z.cross(point_m);
  y = y.norm() > kOnAxisMetres ? y.normalized() : Eigen::Vector3d(frame6_from_tool.linear().col(1));
  Eigen::Matrix3d before;  // in R_6, before theta and r of frame 7: Rot(z, turn) Rot(y, beta) Rot(x, alpha)
  before << y.cross(z), y, z;
  const Eigen::Matrix3d last = before.transpose() * frame6_from_tool.linear();  // Rot(z, theta)
  LinkParameters& link = model.links[kFrameCount - 1];
  link.beta_rad = std::asin(std::clamp(-before(2, 0), -1.0, 1.0));
  // Where beta is a quarter turn, alpha and the turn are about one axis: then the turn has all of it.
  const bool is_quarter = std::hypot(before(2, 1), before(2, 2)) < kQuarterTurnCosine;
  link.alpha_rad = is_quarter ? 0.0 : std::atan2(before(2, 1), before(2, 2));
  const double turn_rad =
      is_quarter ? std::atan2(-before(0, 1), before(1, 1)) : std::atan2(before(1, 0), before(0, 0));
  link.theta_rad = std::atan2(last(1, 0), last(0, 0));
  link.d_m = before.col(0).dot(point_m);
  link.r_m = z.dot(point_m);
  model.links[kJointCount].theta_rad += turn_rad;
}

}  // namespace calib
