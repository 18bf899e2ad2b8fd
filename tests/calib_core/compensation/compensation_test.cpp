#include "calib_core/compensation/compensation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "calib_core/compensation/arm_sides.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/numerics/halton.hpp"
#include "tests/calib_core/block_study.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/reference_poses.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr int kWristFrame = 6;
constexpr std::uint64_t kSeed = 7;

/// With masses of the size of a TX90's, for gravity to act on.
KinematicModel nominal_arm() {
  KinematicModel model = paper::nominal();
  model.masses[2] = {25.0, {0.18, 0.0, 0.05}};
  model.masses[4] = {20.0, {0.0, 0.0, -0.25}};
  model.masses[6] = {2.0, {0.0, 0.0, 0.06}};
  model.masses[7] = {1.5, {0.0, 0.0, -0.15}};
  return model;
}

enum class Droops { kNo, kYes };

/// All 37 errors, drawn, but theta6, which no touch sees.
KinematicModel true_arm(Droops droops) {
  UniformChance chance(kSeed);
  ErrorVector errors = study::draw_errors(chance);
  errors[error_parameter_index("theta6").value()] = 0.0;
  KinematicModel model = apply(nominal_arm(), errors);
  if (droops == Droops::kYes) model.compliance_rad_per_nm = {0.0, 0.8e-6, 2.2e-6, 3e-6, 5e-6, 8e-6};
  return model;
}

CompensationProblem problem_with(const KinematicModel& calibrated) {
  return {.nominal = nominal_arm(), .calibrated = calibrated, .joint_ranges = tx90::joint_ranges()};
}

CompensationTool gripper() {
  Eigen::Isometry3d frame6_from_tool = Eigen::Isometry3d::Identity();
  frame6_from_tool.translate(Eigen::Vector3d(0.03, -0.02, 0.25));
  frame6_from_tool.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()));
  return drawn_tool(frame6_from_tool);
}

/// The controller's world of an arm: R_1 where joint 1 is at 0.
Eigen::Isometry3d block_from_world(const KinematicModel& model) {
  return frame_transform(model.links[0]) * frame_transform(model.links[1]);
}

/// Where a tool of an arm stands in its world, through the whole chain from the block.
Eigen::Isometry3d measured(const KinematicModel& arm, const JointVector& joints,
                           const Eigen::Isometry3d& frame6_from_tool) {
  return block_from_world(arm).inverse() * forward_chain(arm, joints).block_from_frame[kWristFrame] *
         frame6_from_tool;
}

double degrees_apart(const JointVector& a, const JointVector& b) {
  return degrees_from_radians((a - b).cwiseAbs().maxCoeff());
}

void expect_refused(const CompensatedTarget& target, CompensationReason reason) {
  EXPECT_EQ(target.status, CompensationStatus::kRefused);
  EXPECT_EQ(target.reason, reason);
  EXPECT_FALSE(target.joints || target.residual_m || target.tip_std_m);
}

/// 2,000 postures over the joint ranges, a tool with arms of its own and an arm with all errors.
class DrawnArm : public testing::TestWithParam<Droops> {};
INSTANTIATE_TEST_SUITE_P(Droop, DrawnArm, testing::Values(Droops::kNo, Droops::kYes),
                         [](const auto& instance) { return instance.param == Droops::kYes ? "On" : "Off"; });

TEST_P(DrawnArm, StandsAtTheNominalPoseWhereverATargetIsTaken) {
  const KinematicModel truth = true_arm(GetParam());
  const Compensation compensation(problem_with(truth));
  const CompensationTool tool = gripper();
  int taken = 0, warned = 0, near_singular = 0;
  for (int i = 1; i <= 2'000; ++i) {
    const JointVector joints = halton_posture(i, tx90::joint_ranges());
    const CompensatedTarget target = compensation.at_joints(tool, joints);
    const ArmBend bend = arm_bend(forward_chain(nominal_arm(), joints));
    const bool is_singular =
        bend.wrist_margin_rad() < kWristMarginMinRad || bend.elbow_margin_rad() < kElbowMarginMinRad;
    near_singular += is_singular ? 1 : 0;
    EXPECT_TRUE(!is_singular || target.status == CompensationStatus::kRefused);
    if (target.status == CompensationStatus::kRefused) {
      EXPECT_NE(target.reason, CompensationReason::kNone);
      EXPECT_FALSE(target.joints);
      continue;
    }
    ++taken;
    warned += target.status == CompensationStatus::kWarned ? 1 : 0;
    const Eigen::Isometry3d wanted = measured(nominal_arm(), joints, tool.nominal_frame6_from_tool);
    const Eigen::Isometry3d reached = measured(truth, *target.joints, tool.calibrated_frame6_from_tool);
    EXPECT_LT((wanted.translation() - reached.translation()).norm(), kCompensationResidualMax);
    EXPECT_LT((wanted.linear() - reached.linear()).norm(), 2.0 * kCompensationResidualMax);
    EXPECT_LE(*target.residual_m, kCompensationResidualMax);
    const Eigen::Isometry3d uncorrected = measured(truth, joints, tool.calibrated_frame6_from_tool);
    EXPECT_NEAR(*target.moved_m, (wanted.translation() - uncorrected.translation()).norm(), 1e-12);
    EXPECT_GT(*target.moved_m, 1e-5);
    EXPECT_TRUE(tx90::joint_ranges().contains(*target.joints));
    EXPECT_EQ(arm_bend(forward_chain(nominal_arm(), *target.joints)).sides, bend.sides);
  }
  EXPECT_GT(taken, 1'700);
  EXPECT_GT(warned, 50);
  EXPECT_GT(near_singular, 50);
}

TEST_P(DrawnArm, TakesAPoseAsItTakesTheJointsThatHaveIt) {
  const Compensation compensation(problem_with(true_arm(GetParam())));
  const CompensationTool tool = gripper();
  int taken = 0;
  for (int i = 1; i <= 300; ++i) {
    const JointVector joints = halton_posture(i, tx90::joint_ranges());
    const CompensatedTarget by_joints = compensation.at_joints(tool, joints);
    if (by_joints.status == CompensationStatus::kRefused) continue;
    const JointVector near = joints + JointVector::Constant(1e-3);
    const CompensatedTarget by_pose =
        compensation.at_pose(tool, compensation.nominal_world_from_tool(tool, joints), near);
    if (by_pose.status == CompensationStatus::kRefused) continue;  // near stands on another side
    ++taken;
    EXPECT_LT(degrees_apart(*by_joints.joints, *by_pose.joints), 1e-5);
    EXPECT_EQ(by_joints.status, by_pose.status);
    EXPECT_NEAR(*by_joints.moved_m, *by_pose.moved_m, 1e-9);
  }
  EXPECT_GT(taken, 250);
}

/// The file has poses of the nominal arm and of one with the errors of Table III, from an independent
/// program.
TEST(Compensation, FindsTheJointsOfPosesFromAnIndependentProgram) {
  const KinematicModel nominal = paper::nominal(), table3 = apply(nominal, paper::table3());
  const Compensation compensation(
      {.nominal = nominal, .calibrated = table3, .joint_ranges = tx90::joint_ranges()});
  const CompensationTool stylus = stylus_tool(nominal, table3);
  int found = 0;
  for (const ReferencePose& pose : read_reference_poses()) {
    if (!pose.table3) {
      const Eigen::Isometry3d world_from_tip = block_from_world(nominal).inverse() * pose.block_from_tip;
      EXPECT_TRUE(compensation.nominal_world_from_tool(stylus, pose.joints).isApprox(world_from_tip, 1e-9));
      continue;
    }
    const Eigen::Isometry3d world_from_tip = block_from_world(table3).inverse() * pose.block_from_tip;
    const CompensatedTarget target = compensation.at_pose(stylus, world_from_tip, pose.joints);
    if (target.status == CompensationStatus::kRefused) continue;
    ++found;
    EXPECT_LT(degrees_apart(*target.joints, pose.joints), 1e-6);
  }
  EXPECT_GE(found, 15);
}

TEST(Compensation, ChangesNothingForAnArmThatIsAsNominalButForItsPlace) {
  KinematicModel moved = nominal_arm();
  for (const char* name : {"theta0", "r0", "alpha1", "d1", "theta1", "r1", "beta1"}) {
    ErrorVector error = ErrorVector::Zero();
    error[error_parameter_index(name).value()] = 0.004;
    moved = apply(moved, error);
  }
  const Compensation compensation(problem_with(moved));
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  for (const CompensationTool& tool : {gripper(), stylus_tool(nominal_arm(), moved)}) {
    const CompensatedTarget target = compensation.at_joints(tool, joints);
    EXPECT_EQ(target.status, CompensationStatus::kOk);
    EXPECT_EQ(*target.joints, joints);
    EXPECT_LT(*target.moved_m, 1e-12);
  }
}

TEST(Compensation, NeverAppliesTheta6) {
  ErrorVector error = ErrorVector::Zero();
  error[error_parameter_index("theta6").value()] = 0.004;
  const Compensation compensation(problem_with(apply(nominal_arm(), error)));
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  EXPECT_EQ(*compensation.at_joints(gripper(), joints).joints, joints);
}

TEST(Compensation, AppliesTheStylusOfTheCalibrationToNoOtherTool) {
  ErrorVector error = ErrorVector::Zero();
  for (const char* name : {"alpha7", "d7", "r7", "beta7"}) error[error_parameter_index(name).value()] = 0.001;
  const KinematicModel calibrated = apply(nominal_arm(), error);
  const Compensation compensation(problem_with(calibrated));
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  EXPECT_EQ(*compensation.at_joints(gripper(), joints).joints, joints);
  const CompensationTool stylus = stylus_tool(nominal_arm(), calibrated);
  const CompensatedTarget target = compensation.at_joints(stylus, joints);
  EXPECT_GT(*target.moved_m, 1e-3);
  EXPECT_LT((measured(nominal_arm(), joints, stylus.nominal_frame6_from_tool).translation() -
             measured(calibrated, *target.joints, stylus.calibrated_frame6_from_tool).translation())
                .norm(),
            kCompensationResidualMax);
}

TEST(Compensation, TakesTheNominalArmForARigidOneAsAControllerDoes) {
  CompensationProblem problem = problem_with(true_arm(Droops::kYes));
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  const CompensatedTarget wanted = Compensation(problem).at_joints(gripper(), joints);
  problem.nominal.compliance_rad_per_nm.fill(5e-6);
  problem.nominal.harmonics_rad.fill({1e-4, 2e-4});
  EXPECT_EQ(*Compensation(problem).at_joints(gripper(), joints).joints, *wanted.joints);
}

TEST(Compensation, RefusesAndWarnsAtTheAnglesThatItNames) {
  const Compensation compensation(problem_with(true_arm(Droops::kYes)));
  struct Case {
    double joint3_deg, joint5_deg;
    CompensationStatus status;
    CompensationReason reason;
  };
  using enum CompensationStatus;
  using enum CompensationReason;
  for (const auto& [joint3_deg, joint5_deg, status, reason] :
       {Case{60.0, 0.0, kRefused, kStraightWrist}, Case{60.0, 1.9, kRefused, kStraightWrist},
        Case{60.0, -1.9, kRefused, kStraightWrist}, Case{60.0, 3.5, kWarned, kStraightWrist},
        Case{60.0, -3.5, kWarned, kStraightWrist}, Case{60.0, 6.0, kOk, kNone},
        Case{0.0, 50.0, kRefused, kStretchedElbow}, Case{3.9, 50.0, kRefused, kStretchedElbow},
        Case{-3.9, 50.0, kRefused, kStretchedElbow}, Case{6.0, 50.0, kWarned, kStretchedElbow},
        Case{-6.0, 50.0, kWarned, kStretchedElbow}, Case{10.0, 50.0, kOk, kNone}}) {
    SCOPED_TRACE(testing::Message() << joint3_deg << " " << joint5_deg);
    const CompensatedTarget target =
        compensation.at_joints(gripper(), tx90::degrees(20.0, 30.0, joint3_deg, 10.0, joint5_deg, -20.0));
    EXPECT_EQ(target.status, status);
    EXPECT_EQ(target.reason, reason);
    EXPECT_EQ(target.joints.has_value(), status != kRefused);
    EXPECT_TRUE(target.moved_m.has_value());
    if (status == kOk) continue;
    const Eigen::Index joint = reason == kStraightWrist ? 4 : 2;
    const double nominal_deg = std::abs(joint == 4 ? joint5_deg : joint3_deg);
    const double commanded_deg =
        target.joints ? std::abs(degrees_from_radians((*target.joints)[joint])) : nominal_deg;
    EXPECT_NEAR(degrees_from_radians(target.angle_rad), std::min(nominal_deg, commanded_deg), 1e-9);
  }
}

TEST(Compensation, ATargetAtTheEndOfARangeIsTakenOnlyWhereTheCorrectionStaysInside) {
  const KinematicModel truth = true_arm(Droops::kYes);
  const Compensation compensation(problem_with(truth));
  const JointRanges ranges = tx90::joint_ranges();
  const JointVector middle = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  int taken = 0, refused = 0;
  for (int joint = 0; joint < kJointCount; ++joint) {
    for (const bool at_upper : {false, true}) {
      SCOPED_TRACE(testing::Message() << "joint " << joint + 1 << (at_upper ? " upper" : " lower"));
      JointVector joints = middle;
      joints[joint] = at_upper ? ranges.upper[joint] : ranges.lower[joint];
      const CompensatedTarget target = compensation.at_joints(gripper(), joints);
      if (target.status == CompensationStatus::kRefused) {
        ++refused;
        expect_refused(target, CompensationReason::kOutOfRange);
        EXPECT_EQ(target.joint, joint + 1);
        EXPECT_TRUE(at_upper ? target.angle_rad > ranges.upper[joint]
                             : target.angle_rad < ranges.lower[joint]);
      } else {
        ++taken;
        EXPECT_TRUE(ranges.contains(*target.joints));
      }
      joints[joint] += at_upper ? 0.01 : -0.01;
      const CompensatedTarget outside = compensation.at_joints(gripper(), joints);
      expect_refused(outside, CompensationReason::kNominalOutOfRange);
      EXPECT_EQ(outside.joint, joint + 1);
      EXPECT_EQ(outside.angle_rad, joints[joint]);
    }
  }
  EXPECT_GT(taken, 0);
  EXPECT_GT(refused, 0);
}

TEST(Compensation, RefusesAPoseThatTheNominalArmDoesNotReach) {
  const Compensation compensation(problem_with(true_arm(Droops::kYes)));
  const JointVector near = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  Eigen::Isometry3d pose = compensation.nominal_world_from_tool(gripper(), near);
  pose.translation() += Eigen::Vector3d(2.0, 0.0, 0.0);
  const CompensatedTarget target = compensation.at_pose(gripper(), pose, near);
  expect_refused(target, CompensationReason::kNominalOutOfReach);
  EXPECT_FALSE(target.moved_m);
}

TEST(Compensation, APoseWithAStraightWristIsRefusedForThat) {
  const Compensation compensation(problem_with(true_arm(Droops::kYes)));
  const JointVector straight = tx90::degrees(20.0, 30.0, 60.0, 10.0, 0.0, -20.0);
  const Eigen::Isometry3d pose = compensation.nominal_world_from_tool(gripper(), straight);
  for (const double near_deg : {-15.0, 15.0}) {
    JointVector near = straight;
    near[4] = radians_from_degrees(near_deg);
    expect_refused(compensation.at_pose(gripper(), pose, near), CompensationReason::kStraightWrist);
  }
}

/// A longer nominal arm reaches what the calibrated one does not: stretched but for 9 degrees, 20 mm shorter.
TEST(Compensation, RefusesAPoseThatOnlyTheNominalArmReaches) {
  KinematicModel shorter = nominal_arm();
  shorter.links[4].r_m -= 0.02;
  const Compensation compensation(problem_with(shorter));
  expect_refused(compensation.at_joints(gripper(), tx90::degrees(20.0, 30.0, 9.0, 10.0, 50.0, -20.0)),
                 CompensationReason::kOutOfReach);
}

/// Joint 3 stands 12 degrees past where the nominal arm has it, which takes the correction through the
/// stretched elbow.
TEST(Compensation, RefusesACorrectionThatWouldChangeTheConfiguration) {
  KinematicModel turned = nominal_arm();
  turned.links[3].theta_rad += radians_from_degrees(12.0);
  const Compensation compensation(problem_with(turned));
  expect_refused(compensation.at_joints(gripper(), tx90::degrees(20.0, 30.0, 9.0, 10.0, 50.0, -20.0)),
                 CompensationReason::kOtherConfiguration);
}

TEST(Compensation, APoseKeepsTheConfigurationAndTheTurnsOfTheNearJoints) {
  const Compensation compensation(problem_with(true_arm(Droops::kYes)));
  const CompensationTool tool = gripper();
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  const Eigen::Isometry3d pose = compensation.nominal_world_from_tool(tool, joints);
  JointVector a_turn_away = joints;
  a_turn_away[5] = radians_from_degrees(250.0);
  const CompensatedTarget turned = compensation.at_pose(tool, pose, a_turn_away);
  ASSERT_TRUE(turned.joints);
  EXPECT_NEAR(degrees_from_radians((*turned.joints)[5]), 340.0 - 360.0, 1.0);  // 340 is outside the range
  JointVector other_wrist = joints;
  other_wrist[3] = radians_from_degrees(-170.0);
  other_wrist[4] = radians_from_degrees(-50.0);
  other_wrist[5] = radians_from_degrees(160.0);
  const CompensatedTarget flipped = compensation.at_pose(tool, pose, other_wrist);
  ASSERT_TRUE(flipped.joints);
  EXPECT_LT(degrees_apart(*flipped.joints, other_wrist), 2.0);
}

/// Found numerically, so that a pose far from the near joints is searched for.
TEST(Compensation, TakesArmsWithoutASphericalWrist) {
  KinematicModel nominal = nominal_arm();
  nominal.links[5].d_m = 0.06;
  nominal.links[6].d_m = 0.04;
  ErrorVector errors = paper::table3();
  const KinematicModel truth = apply(nominal, errors);
  const Compensation compensation(
      {.nominal = nominal, .calibrated = truth, .joint_ranges = tx90::joint_ranges()});
  const CompensationTool tool = gripper();
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  const JointVector near = tx90::degrees(-40.0, 50.0, 90.0, -30.0, 20.0, 30.0);
  const Eigen::Isometry3d pose = compensation.nominal_world_from_tool(tool, joints);
  for (const CompensatedTarget& target :
       {compensation.at_joints(tool, joints), compensation.at_pose(tool, pose, near)}) {
    ASSERT_TRUE(target.joints);
    EXPECT_LT(degrees_apart(*target.joints, joints), 2.0);
    EXPECT_LT(
        (measured(truth, *target.joints, tool.calibrated_frame6_from_tool).translation() - pose.translation())
            .norm(),
        kCompensationResidualMax);
  }
}

TEST(Compensation, TheUncertaintyOfTheToolIsThatOfTheArmAtTheBlock) {
  CompensationProblem problem = problem_with(true_arm(Droops::kYes));
  const JointVector joints = tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0);
  EXPECT_FALSE(Compensation(problem).at_joints(gripper(), joints).tip_std_m);
  const auto std_with = [&](const char* name, const CompensationTool& tool) {
    ArmCovariance covariance = no_covariance();
    const int index = error_parameter_index(name).value();
    covariance(index, index) = 1e-8;  // 0.1 mm or 0.1 mrad
    problem.covariance = covariance;
    return Compensation(problem).at_joints(tool, joints).tip_std_m.value();
  };
  const CompensationTool stylus = stylus_tool(problem.nominal, problem.calibrated);
  EXPECT_NEAR(std_with("d3", gripper()), 1e-4, 1e-9);
  EXPECT_NEAR(std_with("r0", gripper()), 1e-4, 1e-9);  // of the place only what is the arm's: a drift
  EXPECT_EQ(std_with("r7", gripper()), 0.0);
  EXPECT_NEAR(std_with("r7", stylus), 1e-4, 1e-9);
  // 0.1 mrad of joint 2 by the distance of the tool from its axis.
  const Eigen::Isometry3d tool =
      measured(problem.calibrated, *Compensation(problem).at_joints(gripper(), joints).joints,
               gripper().calibrated_frame6_from_tool);
  const Chain chain = forward_chain(problem.calibrated, joints);
  const Eigen::Isometry3d world_from_2 =
      block_from_world(problem.calibrated).inverse() * chain.block_from_frame[2];
  const double lever_m =
      world_from_2.linear().col(2).cross(tool.translation() - world_from_2.translation()).norm();
  EXPECT_NEAR(std_with("theta2", gripper()), 1e-4 * lever_m, 1e-2 * 1e-4 * lever_m);
}

TEST(Compensation, IsForRevoluteJoints) {
  CompensationProblem problem = problem_with(nominal_arm());
  problem.calibrated.joint_types[2] = JointType::kPrismatic;
  EXPECT_THROW(Compensation{problem}, std::logic_error);
}

}  // namespace
}  // namespace calib
