#include "sim_controller/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "calib_core/kinematics/inverse_kinematics.hpp"

namespace sim {
namespace {

/// Two neighbouring postures of a way are not farther apart.
constexpr double kWayStepMaxRadians = 0.1;
/// A line that ends this far from its target posture went through another branch of the arm.
constexpr double kSameBranchRadians = 1e-3;
/// A joint move's steepest place is looked for in pieces that turn all joints together by this much.
constexpr double kPieceRadians = 0.1;
/// Bodies reach this far beyond the frames' origins.
constexpr double kBodyMarginMetres = 0.05;
/// Three points nearer to a straight line, or to one another, than this give no circle.
constexpr double kCircleMetres = 1e-6;
/// Postures of one path; a line of this many is longer than any arm.
constexpr int kPosturesMax = 20'000;

struct Steepness {
  double tip_m = 0.0;
  double turn_rad = 0.0;
};

/// How fast the tool turns when the joints go by `move`, rad.
Eigen::Vector3d turn_of(const Plant& plant, const calib::Chain& chain, const calib::JointVector& move) {
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int joint = 0; joint < calib::kJointCount; ++joint) {
    const auto index = static_cast<std::size_t>(joint);
    turn += plant.nominal.gains[index] * move[joint] * chain.block_from_frame[index + 1].linear().col(2);
  }
  return turn;
}

/// Bounds on the tool's way and turn per share of a joint move, at its steepest place.
Steepness steepest(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to,
                   const Eigen::Isometry3d& tip_from_tool) {
  const calib::JointVector move = to - from;
  const double joints_rad = move.cwiseAbs().sum();
  const int pieces = std::max(1, static_cast<int>(std::ceil(joints_rad / kPieceRadians)));
  Steepness most;
  for (int i = 0; i <= pieces; ++i) {
    const calib::JointVector here = from + (static_cast<double>(i) / pieces) * move;
    const calib::Chain chain = calib::forward_chain(plant.nominal, here);
    const Eigen::Vector3d turn = turn_of(plant, chain, move);
    const Eigen::Vector3d lever_m = chain.block_from_frame.back().linear() * tip_from_tool.translation();
    const Eigen::Vector3d way_m = calib::tip_jacobian(plant.nominal, chain) * move + turn.cross(lever_m);
    most.tip_m = std::max(most.tip_m, way_m.norm());
    most.turn_rad = std::max(most.turn_rad, turn.norm());
  }
  // Between two places the tool's velocity leaves the straight join of theirs by its curvature's eighth.
  const double piece_rad = joints_rad / pieces;
  const double bow = piece_rad * piece_rad / 8.0;
  most.tip_m += bow * (sweep_bound_m(plant, from, to) + joints_rad * tip_from_tool.translation().norm());
  most.turn_rad += bow * joints_rad;
  return most;
}

int posture_count(double length_m, double turn_rad) {
  const double count = std::max(length_m / kLineSpacingMetres, turn_rad / kLineTurnRadians);
  return std::clamp(static_cast<int>(std::ceil(std::min(count, 1.0 * kPosturesMax))), 1, kPosturesMax);
}

/// Whether a way goes on from one posture to the next.
WayEnd end_at(const Plant& plant, const calib::JointVector& from,
              const std::optional<calib::JointVector>& to) {
  if (!to) return WayEnd::kNoPosture;
  if (!plant.joint_ranges.contains(*to)) return WayEnd::kJointRange;
  return (*to - from).cwiseAbs().maxCoeff() < kWayStepMaxRadians ? WayEnd::kAtTarget : WayEnd::kJump;
}

/// The postures of a tool's poses at even shares (0 to 1) of a way, as far as the arm can follow.
template <class PoseAt>
ToolPath follow_poses(const Plant& plant, const calib::JointVector& from, double length_m, double turn_rad,
                      const Eigen::Isometry3d& tip_from_tool, const PoseAt& block_from_tool_at) {
  const Eigen::Isometry3d tool_from_tip = tip_from_tool.inverse();
  const calib::PreparedModel arm = calib::prepare(plant.nominal);
  ToolPath way{.path = {from}, .length_m = length_m};
  const int count = posture_count(length_m, turn_rad);
  for (int i = 1; i <= count && way.complete; ++i) {
    const Eigen::Isometry3d pose = block_from_tool_at(static_cast<double>(i) / count) * tool_from_tip;
    const auto joints = calib::solve_near(arm, pose, way.path.back());
    way.end = end_at(plant, way.path.back(), joints);
    way.complete = way.end == WayEnd::kAtTarget;
    if (way.complete) {
      way.path.push_back(*joints);
    } else if (joints) {
      way.beyond = *joints;
    } else {
      way.refused = pose;
    }
  }
  way.share = static_cast<double>(way.path.size() - 1) / count;
  way.length_m *= way.share;
  if (way.path.size() == 1) way.path.push_back(from);
  return way;
}

/// The circle through three points.
struct Circle {
  Eigen::Vector3d centre_m;
  Eigen::Vector3d axis;  // points turn about it from the first to the second on the shorter way
  double via_rad = 0.0;
  double end_rad = 0.0;  // from the start, over the via point
};

std::optional<Circle> circle_through(const Eigen::Vector3d& start_m, const Eigen::Vector3d& via_m,
                                     const Eigen::Vector3d& end_m) {
  const Eigen::Vector3d to_via_m = via_m - start_m;
  const Eigen::Vector3d to_end_m = end_m - start_m;
  const Eigen::Vector3d normal = to_via_m.cross(to_end_m);
  const double longer_m = std::max(to_via_m.norm(), to_end_m.norm());
  if (std::min(to_via_m.norm(), to_end_m.norm()) < kCircleMetres || normal.norm() < kCircleMetres * longer_m)
    return std::nullopt;
  Circle circle;
  circle.centre_m = start_m + (to_via_m.squaredNorm() * to_end_m.cross(normal) +
                               to_end_m.squaredNorm() * normal.cross(to_via_m)) /
                                  (2.0 * normal.squaredNorm());
  circle.axis = normal.normalized();
  const Eigen::Vector3d first = start_m - circle.centre_m;
  const auto angle_to = [&](const Eigen::Vector3d& point_m) {
    const Eigen::Vector3d arm_m = point_m - circle.centre_m;
    const double rad = std::atan2(circle.axis.dot(first.cross(arm_m)), first.dot(arm_m));
    return rad < 0.0 ? rad + 2.0 * std::numbers::pi : rad;
  };
  circle.via_rad = angle_to(via_m);
  circle.end_rad = angle_to(end_m);
  constexpr double kHalfTurn = std::numbers::pi - 1e-9;
  if (circle.end_rad <= circle.via_rad || circle.via_rad >= kHalfTurn ||
      circle.end_rad - circle.via_rad >= kHalfTurn)
    return std::nullopt;
  return circle;
}

double turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  return from.angularDistance(to);
}

}  // namespace

calib::JointVector posture(const Path& path, double progress) {
  const double knot = std::clamp(progress, 0.0, 1.0) * static_cast<double>(path.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(knot), path.size() - 2);
  const double share = knot - static_cast<double>(index);
  return (1.0 - share) * path[index] + share * path[index + 1];
}

ToolPath line_to_pose(const Plant& plant, const calib::JointVector& from,
                      const Eigen::Isometry3d& block_from_target, const Eigen::Isometry3d& tip_from_tool) {
  const Eigen::Isometry3d first = calib::forward_kinematics(plant.nominal, from) * tip_from_tool;
  const Eigen::Quaterniond first_turn(first.linear());
  const Eigen::Quaterniond last_turn(block_from_target.linear());
  const double length_m = (block_from_target.translation() - first.translation()).norm();
  return follow_poses(
      plant, from, length_m, turn_between(first_turn, last_turn), tip_from_tool, [&](double share) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() = first_turn.slerp(share, last_turn).toRotationMatrix();
        pose.translation() = (1.0 - share) * first.translation() + share * block_from_target.translation();
        return pose;
      });
}

ToolPath straight_line(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to) {
  ToolPath line = line_to_pose(plant, from, calib::forward_kinematics(plant.nominal, to));
  if (line.complete && (line.path.back() - to).cwiseAbs().maxCoeff() > kSameBranchRadians)
    line.complete = false;
  if (line.complete) line.path.back() = to;
  return line;
}

ToolPath arc_to_pose(const Plant& plant, const calib::JointVector& from,
                     const Eigen::Isometry3d& block_from_via, const Eigen::Isometry3d& block_from_target,
                     const Eigen::Isometry3d& tip_from_tool) {
  const Eigen::Isometry3d first = calib::forward_kinematics(plant.nominal, from) * tip_from_tool;
  const auto circle =
      circle_through(first.translation(), block_from_via.translation(), block_from_target.translation());
  if (!circle) return {.path = {from, from}, .complete = false, .end = WayEnd::kNoCircle, .share = 0.0};
  const Eigen::Quaterniond first_turn(first.linear());
  const Eigen::Quaterniond via_turn(block_from_via.linear());
  const Eigen::Quaterniond last_turn(block_from_target.linear());
  const double via_share = circle->via_rad / circle->end_rad;
  const Eigen::Vector3d radius_m = first.translation() - circle->centre_m;
  // The steeper of both turns, as if it went on over the whole arc.
  const double turn_rad = std::max(turn_between(first_turn, via_turn) / via_share,
                                   turn_between(via_turn, last_turn) / (1.0 - via_share));
  return follow_poses(
      plant, from, radius_m.norm() * circle->end_rad, turn_rad, tip_from_tool, [&](double share) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        const Eigen::Quaterniond turn =
            share < via_share ? first_turn.slerp(share / via_share, via_turn)
                              : via_turn.slerp((share - via_share) / (1.0 - via_share), last_turn);
        pose.linear() = turn.toRotationMatrix();
        pose.translation() =
            circle->centre_m + Eigen::AngleAxisd(share * circle->end_rad, circle->axis) * radius_m;
        return pose;
      });
}

double tip_distance_m(const Plant& plant, const calib::JointVector& from, const calib::JointVector& to) {
  return (calib::forward_kinematics(plant.nominal, to).translation() -
          calib::forward_kinematics(plant.nominal, from).translation())
      .norm();
}

PathSlope path_slope(const Plant& plant, const Stretch& stretch, const Eigen::Isometry3d& tip_from_tool) {
  const auto segments = static_cast<double>(stretch.path.size() - 1);
  const double segments_per_share = segments * std::abs(stretch.to - stretch.from);
  const auto first = static_cast<std::size_t>(std::min(stretch.from, stretch.to) * segments);
  const double end = std::min(segments, std::ceil(std::max(stretch.from, stretch.to) * segments));
  const auto last = static_cast<std::size_t>(end);
  PathSlope slope;
  for (std::size_t i = first; i < last; ++i) {
    const calib::JointVector& here = stretch.path[i];
    const calib::JointVector& next = stretch.path[i + 1];
    const Steepness steep = steepest(plant, here, next, tip_from_tool);
    slope.tip_m = std::max(slope.tip_m, segments_per_share * steep.tip_m);
    slope.turn_rad = std::max(slope.turn_rad, segments_per_share * steep.turn_rad);
    const double slowest_joint_s =
        ((next - here).cwiseAbs().array() / plant.joint_speeds_max.array()).maxCoeff();
    slope.joint_seconds = std::max(slope.joint_seconds, segments_per_share * slowest_joint_s);
    slope.joint_rad = std::max(slope.joint_rad, segments_per_share * (next - here).cwiseAbs().maxCoeff());
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
