#include "sim_controller/move_obstacle.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "sim_controller/val3_units.hpp"

namespace sim {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kPercentOfWay = 100.0;
constexpr val3::Config kAnyConfig{val3::Shoulder::kFree, val3::Elbow::kFree, val3::Wrist::kFree};

/// "joint 3 at 150 deg is outside its range from -140 to 140 deg"; nothing where all are within theirs.
std::optional<std::string> range_obstacle(const Plant& plant, const ControllerArm& arm,
                                          const calib::JointVector& joints) {
  if (arm.in_range(joints)) return std::nullopt;
  const calib::JointRanges& ranges = plant.joint_ranges;
  int worst = 0;
  double most_rad = 0.0;
  for (int i = 0; i < calib::kJointCount; ++i) {
    const double beyond_rad = std::max(joints[i] - ranges.upper[i], ranges.lower[i] - joints[i]);
    if (beyond_rad <= most_rad) continue;
    most_rad = beyond_rad;
    worst = i;
  }
  return fmt::format("joint {} at {:.6g} deg is outside its range from {:.6g} to {:.6g} deg", worst + 1,
                     joints[worst] * kDegreesPerRadian, ranges.lower[worst] * kDegreesPerRadian,
                     ranges.upper[worst] * kDegreesPerRadian);
}

/// Why no joints bring the flange to a pose in that configuration; nothing where some do.
std::optional<std::string> pose_obstacle(const Plant& plant, const ControllerArm& arm,
                                         const Eigen::Isometry3d& world_from_flange,
                                         const val3::Config& config, const calib::JointVector& near) {
  if (arm.solve(world_from_flange, config, near)) return std::nullopt;
  if (arm.solve(world_from_flange, kAnyConfig, near))
    return "the pose is within reach, but not in the configuration that the point asks for";
  const std::optional<calib::JointVector> unbounded = arm.posture_beyond_ranges(world_from_flange, near);
  if (!unbounded) return "the pose is out of reach";
  return "the pose is within reach, but beyond the joint ranges: " +
         range_obstacle(plant, arm, *unbounded).value_or("in every posture");
}

Eigen::Isometry3d flange_at_end(const val3::MoveOrder& order) {
  return pose_from_val3(order.to_pose) * pose_from_val3(order.tool).inverse();
}

std::string way_obstacle(const Plant& plant, const ControllerArm& arm, const ToolPath& way) {
  const auto after = [&](const std::string& why) {
    return fmt::format("{}, after {:.3g} % of the way", why, way.share * kPercentOfWay);
  };
  switch (way.end) {
    case WayEnd::kNoCircle:
      return "the three points give no arc: two of them coincide, they lie on a line, or one is half a turn "
             "or more from the one before";
    case WayEnd::kJointRange:
      return after(range_obstacle(plant, arm, way.beyond).value_or("a joint comes to the end of its range"));
    case WayEnd::kJump:
      return after("the way comes to a singular posture");
    case WayEnd::kNoPosture: {
      const Eigen::Isometry3d flange = arm.block_from_world().inverse() * way.refused * arm.tip_from_flange();
      const bool within_reach = arm.posture_beyond_ranges(flange, way.path.back()).has_value();
      return after(within_reach ? "the way comes to a singular posture" : "the way leaves the reach");
    }
    case WayEnd::kAtTarget:
      break;
  }
  return "its end is in another configuration than its start, and no line or arc changes it";
}

}  // namespace

std::string move_obstacle(const Plant& plant, const ControllerArm& arm, const val3::MoveOrder& order,
                          const calib::JointVector& from, const ToolPath& way) {
  if (order.shape != val3::MoveOrder::Shape::kJoint && way.end == WayEnd::kNoCircle)
    return way_obstacle(plant, arm, way);
  if (!order.reachable)
    return pose_obstacle(plant, arm, flange_at_end(order), order.config, from)
        .value_or("no joints bring the tool to the point");
  if (order.shape == val3::MoveOrder::Shape::kJoint)
    return range_obstacle(plant, arm, way.path.back()).value_or("a joint is outside its range");
  return way_obstacle(plant, arm, way);
}

std::string impossible_move_text(const val3::MoveOrder& order, const std::string& why) {
  const char* const name = order.shape == val3::MoveOrder::Shape::kJoint  ? "movej"
                           : order.shape == val3::MoveOrder::Shape::kLine ? "movel"
                                                                          : "movec";
  return fmt::format("{} at {}:{} of task {}: {}", name, order.origin.file, order.origin.line,
                     order.origin.task, why);
}

}  // namespace sim
