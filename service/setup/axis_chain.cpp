#include "service/setup/axis_chain.hpp"

#include <cmath>
#include <numbers>

namespace cell {
namespace {

/// Axes that are nearer to each other than this are one: which way the normal points says nothing then.
constexpr double kOneAxisMetres = 1e-12;
constexpr int kTurnsMax = 200;

/// Turn about and shift along an axis, and what leads from it to the next one.
struct AxisStep {
  double theta_rad = 0.0, r_m = 0.0;
  double beta_rad = 0.0, alpha_rad = 0.0, d_m = 0.0;
};

Eigen::Isometry3d turned(double theta_rad, double r_m) {
  return Eigen::AngleAxisd(theta_rad, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(0.0, 0.0, r_m);
}

/// Of two opposite directions the one within a quarter turn of x.
double within_quarter_turn(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, std::numbers::pi);
  return wrapped <= -std::numbers::pi / 2.0 ? wrapped + std::numbers::pi : wrapped;
}

/// Along the common normal. `axis` in the frame whose z is the axis before it.
AxisStep along_normal(const JointAxis& axis) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), across = z.cross(axis.direction);
  AxisStep step{.theta_rad = within_quarter_turn(std::atan2(across.y(), across.x()))};
  const Eigen::Vector3d x(std::cos(step.theta_rad), std::sin(step.theta_rad), 0.0);
  step.alpha_rad = std::atan2(across.dot(x), axis.direction.z());
  step.d_m = axis.point_m.dot(x);
  // From the foot of the normal on the axis before: the point of this axis that is nearest to it.
  const Eigen::Vector3d y = z.cross(x);
  const double along = -axis.point_m.dot(y) / axis.direction.dot(y);
  step.r_m = axis.point_m.z() + along * axis.direction.z();
  return step;
}

/// The foot on a nearly parallel axis, of the plane that Ry(beta) Rx(alpha) Tx(d) moves in.
AxisStep hayati(JointAxis axis) {
  const bool is_opposite = axis.direction.z() < 0.0;
  if (is_opposite) axis.direction = -axis.direction;
  AxisStep step;
  for (int turn = 0; turn < kTurnsMax; ++turn) {
    const Eigen::Matrix3d back =
        Eigen::AngleAxisd(-step.theta_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d n = back * axis.direction, p = back * axis.point_m;
    step.beta_rad = std::atan2(n.x(), n.z());
    step.alpha_rad = -std::asin(n.y());
    const Eigen::Vector3d level(std::sin(step.beta_rad), 0.0, std::cos(step.beta_rad));
    const Eigen::Vector3d foot = p - p.dot(level) / n.dot(level) * n;
    step.d_m = foot.x() * std::cos(step.beta_rad) - foot.z() * std::sin(step.beta_rad);
    if (foot.norm() < kOneAxisMetres) break;
    const double more = within_quarter_turn(std::atan2(foot.y(), foot.x()));
    if (std::abs(more) < 1e-16) break;
    step.theta_rad += more;
  }
  step.theta_rad = std::remainder(step.theta_rad, 2.0 * std::numbers::pi);
  if (is_opposite) step.alpha_rad += std::numbers::pi;
  return step;
}

AxisStep step_to(const JointAxis& axis) {
  const bool is_parallel = axis.direction.head<2>().norm() < std::sin(kParallelRadians);
  return is_parallel ? hayati(axis) : along_normal(axis);
}

}  // namespace

calib::KinematicModel model_of_axes(const std::array<JointAxis, calib::kJointCount>& axes,
                                    const Eigen::Isometry3d& base_from_tip) {
  calib::KinematicModel model;
  Eigen::Isometry3d base_from_axis = Eigen::Isometry3d::Identity();
  for (int frame = 0; frame + 1 < calib::kFrameCount; ++frame) {
    const auto at = static_cast<std::size_t>(frame);
    const Eigen::Isometry3d axis_from_base = base_from_axis.inverse();
    const JointAxis next =
        at < axes.size() ? axes[at] : JointAxis{base_from_tip.translation(), base_from_tip.linear().col(2)};
    const AxisStep step = step_to({axis_from_base * next.point_m, axis_from_base.linear() * next.direction});
    model.links[at].theta_rad = step.theta_rad;
    model.links[at].r_m = step.r_m;
    model.links[at + 1].alpha_rad = step.alpha_rad;
    model.links[at + 1].d_m = step.d_m;
    model.links[at + 1].beta_rad = step.beta_rad;
    base_from_axis =
        base_from_axis * turned(step.theta_rad, step.r_m) * calib::frame_transform(model.links[at + 1]);
  }
  const Eigen::Isometry3d left = base_from_axis.inverse() * base_from_tip;
  model.links.back().theta_rad = std::atan2(left.linear()(1, 0), left.linear()(0, 0));
  model.links.back().r_m = left.translation().z();
  return model;
}

}  // namespace cell
