#include "sim_controller/controller_arm.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace sim {
namespace {

constexpr double kRangeRoundingRadians = 1e-6 * std::numbers::pi / 180.0;

calib::KinematicModel world_to_flange(const Plant& plant, double wrist_to_flange_m) {
  calib::KinematicModel model = plant.nominal;
  model.links[0] = {};
  model.links[1] = {};
  model.links[calib::kFrameCount - 1] = {.r_m = wrist_to_flange_m};
  return model;
}

calib::JointRanges widened(calib::JointRanges ranges) {
  ranges.lower.array() -= kRangeRoundingRadians;
  ranges.upper.array() += kRangeRoundingRadians;
  return ranges;
}

template <class Side>
bool side_is_allowed(Side demanded, Side start, Side found) {
  if (demanded == Side::kFree) return true;
  return found == (demanded == Side::kSame ? start : demanded);
}

}  // namespace

ControllerArm::ControllerArm(const Plant& plant, double wrist_to_flange_m)
    : model_(world_to_flange(plant, wrist_to_flange_m)),
      ranges_(widened(plant.joint_ranges)),
      inverse_(model_) {
  const auto last_link = [](const calib::KinematicModel& model) {
    return calib::frame_transform(model.links[calib::kFrameCount - 1]);
  };
  tip_from_flange_ = last_link(plant.nominal).inverse() * last_link(model_);
  const calib::JointVector any = plant.start_joints;
  block_from_world_ = calib::forward_kinematics(plant.nominal, any) * tip_from_flange_ *
                      calib::forward_kinematics(model_, any).inverse();
}

Eigen::Isometry3d ControllerArm::world_from_flange(const calib::JointVector& joints) const {
  return calib::forward_kinematics(model_, joints);
}

std::optional<calib::JointVector> ControllerArm::nearest_turns(const calib::JointVector& joints,
                                                               const calib::JointVector& near) const {
  calib::JointVector nearest = joints;
  for (int i = 0; i < calib::kJointCount; ++i) {
    const double turn = inverse_.turns()[i];
    nearest[i] += std::round((near[i] - nearest[i]) / turn) * turn;
    if (nearest[i] > ranges_.upper[i]) nearest[i] -= turn;
    if (nearest[i] < ranges_.lower[i]) nearest[i] += turn;
  }
  if (!ranges_.contains(nearest)) return std::nullopt;
  return nearest;
}

std::optional<calib::JointVector> ControllerArm::solve(const Eigen::Isometry3d& world_from_flange,
                                                       const val3::Config& config,
                                                       const calib::JointVector& near) const {
  const val3::Config start = config_of(near);
  std::optional<calib::JointVector> best;
  double best_rad = std::numeric_limits<double>::infinity();
  const auto consider = [&](const calib::JointVector& joints) {
    if (!is_allowed(config, start, config_of(joints))) return;
    const auto candidate = nearest_turns(joints, near);
    if (!candidate) return;
    const double way_rad = (*candidate - near).cwiseAbs().sum();
    if (way_rad >= best_rad) return;
    best = candidate;
    best_rad = way_rad;
  };
  // Where the wrist is straight the closed form knows one posture of many; this is the nearest of them.
  if (const auto joints = calib::solve_near(model_, world_from_flange, near)) consider(*joints);
  for (const calib::JointVector& joints : inverse_.solve(world_from_flange)) consider(joints);
  return best;
}

std::optional<calib::JointVector> ControllerArm::posture_beyond_ranges(
    const Eigen::Isometry3d& world_from_flange, const calib::JointVector& near) const {
  std::optional<calib::JointVector> best;
  for (const calib::JointVector& joints : inverse_.solve(world_from_flange)) {
    if (!best || (joints - near).cwiseAbs().sum() < (*best - near).cwiseAbs().sum()) best = joints;
  }
  return best;
}

val3::Config ControllerArm::config_of(const calib::JointVector& joints) const {
  const double wrist_ahead_m = model_.links[2].d_m + model_.links[3].d_m * std::sin(joints[1]) +
                               model_.links[4].r_m * std::sin(joints[1] + joints[2]);
  return {.shoulder = wrist_ahead_m >= 0.0 ? val3::Shoulder::kLefty : val3::Shoulder::kRighty,
          .elbow = joints[2] >= 0.0 ? val3::Elbow::kPositive : val3::Elbow::kNegative,
          .wrist = joints[4] >= 0.0 ? val3::Wrist::kPositive : val3::Wrist::kNegative};
}

bool ControllerArm::in_range(const calib::JointVector& joints) const { return ranges_.contains(joints); }

bool is_allowed(const val3::Config& demanded, const val3::Config& start, const val3::Config& found) {
  return side_is_allowed(demanded.shoulder, start.shoulder, found.shoulder) &&
         side_is_allowed(demanded.elbow, start.elbow, found.elbow) &&
         side_is_allowed(demanded.wrist, start.wrist, found.wrist);
}

}  // namespace sim
