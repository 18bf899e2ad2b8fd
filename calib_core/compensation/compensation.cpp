#include "calib_core/compensation/compensation.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace calib {
namespace {

constexpr std::size_t kWristFrame = 6;

/// The arm from the controller's world on: nothing lies before the motion of joint 1.
KinematicModel in_controllers_world(KinematicModel model) {
  model.links[0] = {};
  model.links[1] = {};
  return model;
}

KinematicModel as_the_controller_has_it(const KinematicModel& given) {
  KinematicModel model = in_controllers_world(given);
  model.links.back() = {};
  model.compliance_rad_per_nm = {};
  model.harmonics_rad = kEvenJoints;
  model.second_harmonics_rad = kEvenJoints;
  model.ripples_rad = kEvenJoints;
  return model;
}

/// With the place of the block before it.
KinematicModel as_it_was_calibrated(const KinematicModel& nominal, const KinematicModel& calibrated) {
  KinematicModel model = calibrated;
  model.links[kWristFrame].theta_rad = nominal.links[kWristFrame].theta_rad;
  return model;
}

JointRanges widened(JointRanges ranges) {
  ranges.lower.array() -= kRangeRoundingRad;
  ranges.upper.array() += kRangeRoundingRad;
  return ranges;
}

/// What is left from a tool to the target: metres above radians.
struct TargetGap {
  Chain chain;
  Eigen::Vector3d tool_m;
  Eigen::Matrix<double, 6, 1> left;

  [[nodiscard]] double distance_m() const { return left.head<3>().norm(); }
  [[nodiscard]] double angle_rad() const { return left.tail<3>().norm(); }
  [[nodiscard]] bool is_within(double limit) const { return distance_m() < limit && angle_rad() < limit; }
};

TargetGap gap_to(const PreparedModel& arm, const JointVector& joints,
                 const Eigen::Isometry3d& frame6_from_tool, const Eigen::Isometry3d& wanted) {
  TargetGap gap{.chain = forward_chain(arm, joints)};
  const Eigen::Isometry3d reached = gap.chain.block_from_frame[kWristFrame] * frame6_from_tool;
  gap.tool_m = reached.translation();
  // Sine of the angle times the axis: near enough for steps, and exact where it is compared.
  const Eigen::Matrix3d turn = wanted.linear() * reached.linear().transpose();
  gap.left << wanted.translation() - gap.tool_m, 0.5 * (turn(2, 1) - turn(1, 2)),
      0.5 * (turn(0, 2) - turn(2, 0)), 0.5 * (turn(1, 0) - turn(0, 1));
  return gap;
}

/// One step of Newton's method. How gravity changes with the posture is neglected: it is 3e-4 of the step.
JointVector newton_step(const PreparedModel& arm, const TargetGap& gap) {
  Eigen::Matrix<double, 6, kJointCount> jacobian;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const Eigen::Isometry3d& frame = gap.chain.block_from_frame[joint + 1];
    const Eigen::Vector3d axis = arm.model.gains[joint] * frame.linear().col(2);
    const auto column = static_cast<Eigen::Index>(joint);
    jacobian.col(column) << axis.cross(gap.tool_m - frame.translation()), axis;
  }
  return jacobian.partialPivLu().solve(gap.left);
}

/// What is said of a posture that is near to losing a direction.
struct Nearness {
  CompensationStatus status = CompensationStatus::kOk;
  CompensationReason reason = CompensationReason::kNone;
  double angle_rad = 0.0;
};

Nearness nearness_of(double wrist_rad, double elbow_rad) {
  for (const auto& [share, status] : {std::pair{1.0, CompensationStatus::kRefused},
                                      std::pair{kWarnedWithin, CompensationStatus::kWarned}}) {
    if (wrist_rad < share * kWristMarginMinRad)
      return {status, CompensationReason::kStraightWrist, wrist_rad};
    if (elbow_rad < share * kElbowMarginMinRad)
      return {status, CompensationReason::kStretchedElbow, elbow_rad};
  }
  return {};
}

}  // namespace

CompensationTool drawn_tool(const Eigen::Isometry3d& frame6_from_tool) {
  return {.nominal_frame6_from_tool = frame6_from_tool, .calibrated_frame6_from_tool = frame6_from_tool};
}

CompensationTool stylus_tool(const KinematicModel& nominal, const KinematicModel& calibrated) {
  return {.nominal_frame6_from_tool = frame_transform(nominal.links.back()),
          .calibrated_frame6_from_tool = frame_transform(calibrated.links.back()),
          .is_stylus = true};
}

KinematicModel calibrated_in_controllers_world(const KinematicModel& nominal,
                                               const KinematicModel& calibrated) {
  return in_controllers_world(as_it_was_calibrated(nominal, calibrated));
}

Compensation::Compensation(const CompensationProblem& problem)
    : nominal_(prepare(as_the_controller_has_it(problem.nominal))),
      calibrated_(prepare(calibrated_in_controllers_world(problem.nominal, problem.calibrated))),
      calibrated_at_block_(prepare(as_it_was_calibrated(problem.nominal, problem.calibrated))),
      inverse_(nominal_.model),
      ranges_(widened(problem.joint_ranges)),
      world_from_block_(
          (frame_transform(problem.nominal.links[0]) * frame_transform(problem.nominal.links[1])).inverse()),
      covariance_(problem.covariance ? std::optional<ArmMatrix>(*problem.covariance) : std::nullopt) {
  for (const KinematicModel* model : {&problem.nominal, &problem.calibrated}) {
    if (std::ranges::find(model->joint_types, JointType::kPrismatic) != model->joint_types.end())
      throw std::logic_error("targets are compensated for six revolute joints only");
  }
}

Eigen::Isometry3d Compensation::nominal_world_from_tool(const CompensationTool& tool,
                                                        const JointVector& joints) const {
  return forward_chain(nominal_, joints).block_from_frame[kWristFrame] * tool.nominal_frame6_from_tool;
}

Eigen::Isometry3d Compensation::calibrated_world_from_tool(const CompensationTool& tool,
                                                           const JointVector& joints) const {
  return forward_chain(calibrated_, joints).block_from_frame[kWristFrame] * tool.calibrated_frame6_from_tool;
}

CompensatedTarget Compensation::at_joints(const CompensationTool& tool, const JointVector& joints) const {
  return corrected(tool, nominal_world_from_tool(tool, joints), joints);
}

CompensatedTarget Compensation::at_pose(const CompensationTool& tool,
                                        const Eigen::Isometry3d& world_from_tool,
                                        const JointVector& near) const {
  const auto joints = nominal_posture(world_from_tool * tool.nominal_frame6_from_tool.inverse(), near);
  if (!joints) return {.reason = CompensationReason::kNominalOutOfReach};
  return corrected(tool, world_from_tool, *joints);
}

Postures Compensation::nominal_postures(const CompensationTool& tool,
                                        const Eigen::Isometry3d& world_from_tool) const {
  return inverse_.solve(world_from_tool * tool.nominal_frame6_from_tool.inverse());
}

std::optional<JointVector> Compensation::nominal_follow(const CompensationTool& tool,
                                                        const Eigen::Isometry3d& world_from_tool,
                                                        const JointVector& start) const {
  return inverse_.follow(world_from_tool * tool.nominal_frame6_from_tool.inverse(), start);
}

ArmBend Compensation::nominal_bend(const JointVector& joints) const {
  return arm_bend(forward_chain(nominal_, joints));
}

ArmSides Compensation::nominal_sides(const JointVector& joints) const { return nominal_bend(joints).sides; }

int Compensation::joint_out_of_range(const JointVector& joints) const {
  for (int joint = 0; joint < kJointCount; ++joint) {
    if (joints[joint] < ranges_.lower[joint] || joints[joint] > ranges_.upper[joint]) return joint + 1;
  }
  return 0;
}

std::optional<JointVector> Compensation::nominal_posture(const Eigen::Isometry3d& world_from_frame6,
                                                         const JointVector& near) const {
  const ArmSides sides = nominal_sides(near);
  const auto is_on_their_side = [&](const JointVector& joints) { return nominal_sides(joints) == sides; };
  const auto with_turns_of_near = [&](JointVector joints) {
    for (int joint = 0; joint < kJointCount; ++joint) {
      const double turn = inverse_.turns()[joint];
      joints[joint] += std::round((near[joint] - joints[joint]) / turn) * turn;
      if (joints[joint] > ranges_.upper[joint] && joints[joint] - turn >= ranges_.lower[joint])
        joints[joint] -= turn;
      if (joints[joint] < ranges_.lower[joint] && joints[joint] + turn <= ranges_.upper[joint])
        joints[joint] += turn;
    }
    return joints;
  };
  // A straight wrist or a stretched elbow is on no side: it is refused as such.
  const auto is_on_no_side = [&](const JointVector& joints) {
    const ArmBend bend = nominal_bend(joints);
    return bend.wrist_margin_rad() < kWristMarginMinRad || bend.elbow_margin_rad() < kElbowMarginMinRad;
  };
  if (const auto joints = inverse_.follow(world_from_frame6, near);
      joints && (is_on_their_side(*joints) || is_on_no_side(*joints)))
    return with_turns_of_near(*joints);
  // Only an arm without the closed form gets here with a pose that it reaches.
  std::optional<JointVector> nearest;
  for (const JointVector& posture : inverse_.solve(world_from_frame6)) {
    if (!is_on_their_side(posture)) continue;
    const JointVector joints = with_turns_of_near(posture);
    if (!nearest || (joints - near).cwiseAbs().sum() < (*nearest - near).cwiseAbs().sum()) nearest = joints;
  }
  return nearest;
}

CompensatedTarget Compensation::corrected(const CompensationTool& tool,
                                          const Eigen::Isometry3d& world_from_tool,
                                          const JointVector& nominal_joints) const {
  constexpr int kStepsMax = 10;
  constexpr double kStepMaxRad = 0.2;  // of any joint: a longer one may land on another side
  constexpr double kGoal = 0.01 * kCompensationResidualMax;
  JointVector joints = nominal_joints;
  const auto gap_here = [&] {
    return gap_to(calibrated_, joints, tool.calibrated_frame6_from_tool, world_from_tool);
  };
  TargetGap gap = gap_here();
  CompensatedTarget target{.moved_m = gap.distance_m()};
  const auto refused = [&target](CompensationReason reason, int joint, double angle_rad) {
    target.status = CompensationStatus::kRefused;
    target.reason = reason;
    target.joint = joint;
    target.angle_rad = angle_rad;
    return target;
  };
  if (const int joint = joint_out_of_range(joints))
    return refused(CompensationReason::kNominalOutOfRange, joint, joints[joint - 1]);
  const ArmBend meant = nominal_bend(nominal_joints);
  if (const Nearness near = nearness_of(meant.wrist_margin_rad(), meant.elbow_margin_rad());
      near.status == CompensationStatus::kRefused)
    return refused(near.reason, 0, near.angle_rad);

  for (int step = 0; step < kStepsMax && !gap.is_within(kGoal); ++step) {
    const JointVector move = newton_step(calibrated_, gap);
    if (!move.allFinite()) break;
    joints += std::min(1.0, kStepMaxRad / std::max(move.cwiseAbs().maxCoeff(), kGoal)) * move;
    gap = gap_here();
  }
  if (!gap.is_within(kCompensationResidualMax)) return refused(CompensationReason::kOutOfReach, 0, 0.0);

  const ArmBend bend = nominal_bend(joints);
  if (bend.sides != meant.sides) return refused(CompensationReason::kOtherConfiguration, 0, 0.0);
  if (const int joint = joint_out_of_range(joints))
    return refused(CompensationReason::kOutOfRange, joint, joints[joint - 1]);
  const Nearness near = nearness_of(std::min(bend.wrist_margin_rad(), meant.wrist_margin_rad()),
                                    std::min(bend.elbow_margin_rad(), meant.elbow_margin_rad()));
  if (near.status == CompensationStatus::kRefused) return refused(near.reason, 0, near.angle_rad);
  target.status = near.status;
  target.reason = near.reason;
  target.angle_rad = near.angle_rad;
  target.joints = joints;
  target.residual_m = gap.distance_m();
  if (tool.std_tip_m) {
    target.tip_std_m = tool.std_tip_m;
  } else if (covariance_) {
    const ToolCentre centre = tool.is_stylus ? std::nullopt : ToolCentre(tool.calibrated_frame6_from_tool);
    target.tip_std_m =
        tip_std_m(calibrated_at_block_, forward_chain(calibrated_at_block_, joints), *covariance_, centre);
  }
  return target;
}

}  // namespace calib
