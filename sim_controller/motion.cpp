#include "sim_controller/motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calib_core/kinematics/inverse_kinematics.hpp"

namespace sim {
namespace {

/// A line that ends this far from its target posture went through another branch of the arm.
constexpr double kSameBranchRadians = 1e-3;
/// A joint move's steepest place is looked for in pieces that turn all joints together by this much.
constexpr double kPieceRadians = 0.1;
/// Bodies reach this far beyond the frames' origins.
constexpr double kBodyMarginMetres = 0.05;

/// Bound on the tool's way per share of a joint move, at its steepest place.
double steepest_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to) {
  const calib::JointVector move = to - from;
  const double turn_rad = move.cwiseAbs().sum();
  const int pieces = std::max(1, static_cast<int>(std::ceil(turn_rad / kPieceRadians)));
  double steepest = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const calib::JointVector here = from + (static_cast<double>(i) / pieces) * move;
    const calib::Chain chain = calib::forward_chain(plant.nominal, here);
    steepest = std::max(steepest, (calib::tip_jacobian(plant.nominal, chain) * move).norm());
  }
  // Between two places the tool's velocity leaves the straight join of theirs by its curvature's eighth.
  const double piece_rad = turn_rad / pieces;
  return steepest + piece_rad * piece_rad / 8.0 * sweep_bound_m(plant, from, to);
}

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

PathSlope path_slope(const Plant& plant, const Stretch& stretch) {
  const auto segments = static_cast<double>(stretch.path.size() - 1);
  const double segments_per_share = segments * std::abs(stretch.to - stretch.from);
  const auto first = static_cast<std::size_t>(std::min(stretch.from, stretch.to) * segments);
  const double end = std::min(segments, std::ceil(std::max(stretch.from, stretch.to) * segments));
  const auto last = static_cast<std::size_t>(end);
  PathSlope slope;
  for (std::size_t i = first; i < last; ++i) {
    const calib::JointVector& here = stretch.path[i];
    const calib::JointVector& next = stretch.path[i + 1];
    slope.tip_m = std::max(slope.tip_m, segments_per_share * steepest_m(plant, here, next));
    const double slowest_joint_s =
        ((next - here).cwiseAbs().array() / plant.joint_speeds_max.array()).maxCoeff();
    slope.joint_seconds = std::max(slope.joint_seconds, segments_per_share * slowest_joint_s);
  }
  return slope;
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
