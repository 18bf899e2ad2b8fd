#include "calib_core/kinematics/gravity.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "calib_core/kinematics/error_parameters.hpp"
#include "tests/calib_core/paper.hpp"

namespace calib {
namespace {

constexpr double kQuarterTurn = std::numbers::pi / 2;

/// The paper's arm with masses about as large as a TX90's.
KinematicModel heavy_arm() {
  KinematicModel model = apply(paper::nominal(), paper::table3());
  model.masses[1] = {40.0, {0.0, 0.0, -0.2}};
  model.masses[2] = {20.0, {0.25, 0.0, 0.1}};
  model.masses[3] = {10.0, {0.0, 0.05, 0.0}};
  model.masses[4] = {8.0, {0.0, 0.0, -0.15}};
  model.masses[6] = {2.0, {0.0, 0.01, 0.05}};
  model.masses[7] = {0.5, {0.0, 0.0, -0.1}};
  return model;
}

JointVector some_joints() { return {0.4, -0.7, 1.1, 0.3, 0.9, -1.2}; }

/// Work that gravity has done, up to a constant: its slopes by the joints are the moments.
double work_of_gravity(const KinematicModel& model, const JointVector& joints) {
  const Chain chain = forward_chain(model, joints);
  const Eigen::Vector3d down =
      chain.block_from_frame[0].linear() * frame_transform(model.links[1]).linear() * model.down_in_frame_1;
  double work = 0.0;
  for (std::size_t frame = 1; frame < kFrameCount; ++frame) {
    const PointMass& here = model.masses[frame];
    work += here.mass_kg * kFreeFall * down.dot(chain.block_from_frame[frame] * here.center_in_frame_m);
  }
  return work;
}

double slope_of_work(const KinematicModel& model, const JointVector& joints, int joint) {
  const auto central = [&](double h) {
    const JointVector move = h * JointVector::Unit(joint);
    return (work_of_gravity(model, joints + move) - work_of_gravity(model, joints - move)) / (2.0 * h);
  };
  return (4.0 * central(5e-4) - central(1e-3)) / 3.0;
}

TEST(Gravity, PullsAHorizontalUpperArmDown) {
  KinematicModel model = paper::nominal();
  model.masses[3] = {12.0, Eigen::Vector3d::Zero()};  // at the elbow
  const auto torques_at = [&](double joint2_rad) {
    return gravity_torques_nm(model, forward_chain(model, joint2_rad * JointVector::Unit(1)));
  };
  // At zero the arm stands upright; joint 2 turns it forward.
  const double upper_arm_m = model.links[3].d_m;
  EXPECT_NEAR(torques_at(0.0)[1], 0.0, 1e-12);
  EXPECT_NEAR(torques_at(kQuarterTurn)[1], 12.0 * kFreeFall * upper_arm_m, 1e-10);
  EXPECT_NEAR(torques_at(-kQuarterTurn)[1], -12.0 * kFreeFall * upper_arm_m, 1e-10);
  EXPECT_NEAR(torques_at(kQuarterTurn)[2], 0.0, 1e-12);  // the mass is on joint 3's axis
}

TEST(Gravity, MomentsAreTheWorkPerRadianOfEachJoint) {
  KinematicModel model = heavy_arm();
  model.gains[2] = -1.0;
  const auto torques = gravity_torques_nm(model, forward_chain(model, some_joints()));
  for (int joint = 0; joint < kJointCount; ++joint) {
    EXPECT_NEAR(torques[joint], slope_of_work(model, some_joints(), joint), 1e-8) << "joint " << joint + 1;
  }
  EXPECT_GT(torques.cwiseAbs()[1], 10.0);
  EXPECT_NEAR(torques[0], 0.0, 1e-12);  // joint 1 stands upright
}

TEST(Gravity, OfAnArmOnAWallPullsAtJoint1AndItsMomentsAreTheWorkPerRadian) {
  KinematicModel model = heavy_arm();
  model.down_in_frame_1 = Eigen::Vector3d(0.6, -0.8, 0.0);
  const auto torques = gravity_torques_nm(model, forward_chain(model, some_joints()));
  for (int joint = 0; joint < kJointCount; ++joint) {
    EXPECT_NEAR(torques[joint], slope_of_work(model, some_joints(), joint), 1e-8) << "joint " << joint + 1;
  }
  EXPECT_GT(std::abs(torques[0]), 10.0);
}

TEST(Gravity, TorquesOfTheMassesAddUpToTheTorques) {
  KinematicModel model = heavy_arm();
  model.gains[4] = -2.0;
  const PreparedModel prepared = prepare(model);
  const Chain chain = forward_chain(prepared, some_joints());
  const JointVector sum_nm = gravity_torques_of_masses_nm(prepared, chain).rowwise().sum();
  EXPECT_LT((sum_nm - gravity_torques_nm(prepared, chain)).norm(), 1e-12);
}

TEST(Gravity, HangingArmIsPulledTheOtherWay) {
  KinematicModel hanging = heavy_arm();
  const Chain chain = forward_chain(hanging, some_joints());
  const JointVector standing_nm = gravity_torques_nm(hanging, chain);
  hanging.down_in_frame_1 = -hanging.down_in_frame_1;
  EXPECT_EQ(gravity_torques_nm(hanging, chain), -standing_nm);
}

TEST(Gravity, DoesNotBendAPrismaticJoint) {
  KinematicModel model = heavy_arm();
  model.joint_types[1] = JointType::kPrismatic;
  EXPECT_EQ(gravity_torques_nm(model, forward_chain(model, some_joints()))[1], 0.0);
}

TEST(Gravity, TurnsACompliantJointByComplianceTimesMoment) {
  const KinematicModel rigid = heavy_arm();
  KinematicModel compliant = rigid;
  compliant.compliance_rad_per_nm = {0.0, 3e-6, 2e-6, 0.0, 0.0, 0.0};
  const JointVector torques = gravity_torques_nm(rigid, forward_chain(rigid, some_joints()));
  JointVector where_it_stands = some_joints();
  where_it_stands[1] += 3e-6 * torques[1];
  where_it_stands[2] += 2e-6 * torques[2];
  const Eigen::Isometry3d bent = forward_kinematics(compliant, some_joints());
  EXPECT_LT((bent.matrix() - forward_kinematics(rigid, where_it_stands).matrix()).norm(), 1e-14);
  EXPECT_GT(work_of_gravity(compliant, some_joints()), work_of_gravity(rigid, some_joints()));
}

TEST(Gravity, LeavesARigidArmWhereItIsWhateverItsMasses) {
  KinematicModel weightless = heavy_arm();
  weightless.masses = {};
  EXPECT_EQ(forward_kinematics(heavy_arm(), some_joints()).matrix(),
            forward_kinematics(weightless, some_joints()).matrix());
}

}  // namespace
}  // namespace calib
