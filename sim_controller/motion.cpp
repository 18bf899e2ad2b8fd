#include "sim_controller/motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calib_core/inverse_kinematics.hpp"

namespace sim {
namespace {

/// A line that ends this far from its target posture went through another branch of the arm.
constexpr double kSameBranchRadians = 1e-3;
/// Samples of a joint move's tool speed.
constexpr int kSpeedSamples = 16;
/// Bodies reach this far beyond the frames' origins.
constexpr double kBodyMarginMetres = 0.05;

}  // namespace

calib::JointVector posture(const Path& path, double progress) {
  const double knot = std::clamp(progress, 0.0, 1.0) * static_cast<double>(path.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(knot), path.size() - 2);
  const double share = knot - static_cast<double>(index);
  return (1.0 - share) * path[index] + share * path[index + 1];
}

StraightLine straight_line(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to) {
  const Eigen::Isometry3d first = calib::forward_kinematics(plant.nominal, from);
  const Eigen::Isometry3d last = calib::forward_kinematics(plant.nominal, to);
  const Eigen::Quaterniond first_turn(first.linear());
  const Eigen::Quaterniond last_turn(last.linear());

  StraightLine line;
  line.length_m = (last.translation() - first.translation()).norm();
  line.path.push_back(from);
  const int count = std::max(1, static_cast<int>(std::ceil(line.length_m / kLineSpacingMetres)));
  for (int i = 1; i <= count && line.complete; ++i) {
    const double share = static_cast<double>(i) / count;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = first_turn.slerp(share, last_turn).toRotationMatrix();
    pose.translation() = (1.0 - share) * first.translation() + share * last.translation();
    const auto joints = calib::solve_near(plant.nominal, pose, line.path.back());
    line.complete = joints && plant.joint_ranges.contains(*joints) &&
                    (*joints - line.path.back()).cwiseAbs().maxCoeff() < 0.1;
    if (line.complete) line.path.push_back(*joints);
  }
  if (line.complete && (line.path.back() - to).cwiseAbs().maxCoeff() > kSameBranchRadians)
    line.complete = false;
  if (line.complete) line.path.back() = to;
  line.length_m *= static_cast<double>(line.path.size() - 1) / count;
  if (line.path.size() == 1) line.path.push_back(from);
  return line;
}

double tip_distance_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to) {
  return (calib::forward_kinematics(plant.nominal, to).translation() -
          calib::forward_kinematics(plant.nominal, from).translation())
      .norm();
}

double duration_s(const Plant& plant, const Stretch& stretch, double speed_m_s) {
  double step_max_m = 0.0;
  double joint_time_s = 0.0;
  calib::JointVector previous = stretch.at(0.0);
  for (int i = 1; i <= kSpeedSamples; ++i) {
    const calib::JointVector next = stretch.at(static_cast<double>(i) / kSpeedSamples);
    step_max_m = std::max(step_max_m, tip_distance_m(plant, previous, next));
    const double slowest_joint_s =
        ((next - previous).cwiseAbs().array() / plant.joint_speeds_max.array()).maxCoeff();
    joint_time_s = std::max(joint_time_s, kSpeedSamples * slowest_joint_s);
    previous = next;
  }
  const double length_m = kSpeedSamples * step_max_m;
  const double a = kAccelerationMetresPerSecond2;
  const double tip_time_s = length_m > speed_m_s * speed_m_s / a ? length_m / speed_m_s + speed_m_s / a
                                                                 : 2.0 * std::sqrt(length_m / a);
  return std::max(tip_time_s, joint_time_s);
}

double sweep_bound_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to) {
  double bound_m = 0.0;
  double reach_m = kBodyMarginMetres;
  for (int joint = calib::kJointCount - 1; joint >= 0; --joint) {
    const auto next_frame = static_cast<std::size_t>(joint) + 2;
    const auto span_m = [next_frame](const calib::KinematicModel& model) {
      return std::abs(model.links[next_frame].d_m) + std::abs(model.links[next_frame].r_m);
    };
    reach_m += std::max(span_m(plant.nominal), span_m(plant.truth));
    bound_m += std::abs(to[joint] - from[joint]) * reach_m;
  }
  return bound_m;
}

}  // namespace sim
