#include "calib_core/kinematics/kinematic_model.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/gravity.hpp"
#include "calib_core/kinematics/place_group.hpp"
#include "calib_core/numerics/decompositions.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/reference_poses.hpp"

namespace calib {
namespace {

JointVector some_joints(double shift) {
  return (JointVector() << 0.4 + shift, -0.7, 1.1 - shift, 0.3, 0.9 + shift, -1.2).finished();
}

TEST(KinematicModel, AgreesWithPosesFromAnIndependentProgram) {
  const auto poses = read_reference_poses();
  ASSERT_EQ(poses.size(), 40u);
  const KinematicModel nominal = paper::nominal();
  const KinematicModel table3 = apply(nominal, paper::table3());
  for (const ReferencePose& pose : poses) {
    const Eigen::Isometry3d computed = forward_kinematics(pose.table3 ? table3 : nominal, pose.joints);
    EXPECT_LT((computed.translation() - pose.block_from_tip.translation()).norm(), kPositionErrorMaxMetres);
    EXPECT_LT((computed.linear() - pose.block_from_tip.linear()).norm(), 1e-10);
  }
}

TEST(KinematicModel, FlangeStandsWhereTheControllersWorldSaysAtZero) {
  // cs8-controller: at J = 0 the flange is at (50, 50, 950) mm in `world`; method notes give world from R_-1.
  KinematicModel to_flange = paper::nominal();
  to_flange.links[7].r_m = 0.100;
  const Eigen::Vector3d p = forward_kinematics(to_flange, JointVector::Zero()).translation();
  const Eigen::Vector3d in_world(p.x() + 0.625, p.z() - 0.1496, -p.y() - 0.1208);
  EXPECT_LT((in_world - Eigen::Vector3d(0.050, 0.050, 0.950)).norm(), 1e-12);
}

/// Central differences of order h^2, extrapolated once: error about 1e-11 for a metre-sized arm.
template <class F>
Eigen::Vector3d numeric_derivative(const F& tip_at) {
  const auto central = [&](double h) -> Eigen::Vector3d { return (tip_at(h) - tip_at(-h)) / (2.0 * h); };
  return (4.0 * central(5e-4) - central(1e-3)) / 3.0;
}

TEST(KinematicModel, JointJacobianMatchesDifferences) {
  const KinematicModel model = apply(paper::nominal(), paper::table3());
  const JointVector joints = some_joints(0.2);
  const auto jacobian = tip_jacobian(model, forward_chain(model, joints));
  for (int joint = 0; joint < kJointCount; ++joint) {
    const auto numeric = numeric_derivative([&](double h) -> Eigen::Vector3d {
      return forward_kinematics(model, joints + h * JointVector::Unit(joint)).translation();
    });
    EXPECT_LT((jacobian.col(joint) - numeric).norm(), 1e-9) << "joint " << joint + 1;
  }
}

TEST(KinematicModel, PrismaticJointMovesAlongItsAxis) {
  KinematicModel model = paper::nominal();
  model.joint_types[2] = JointType::kPrismatic;
  model.gains[2] = -1.0;
  const JointVector joints = some_joints(0.0);
  const auto jacobian = tip_jacobian(model, forward_chain(model, joints));
  const Eigen::Vector3d moved = forward_kinematics(model, joints + 0.1 * JointVector::Unit(2)).translation() -
                                forward_kinematics(model, joints).translation();
  EXPECT_NEAR(moved.norm(), 0.1, 1e-12);
  EXPECT_LT((jacobian.col(2) * 0.1 - moved).norm(), 1e-12);
}

/// Every kind of joint, gain and link: nothing in it is zero.
KinematicModel mixed_arm() {
  KinematicModel model = apply(paper::nominal(), ErrorVector::LinSpaced(-0.05, 0.08));
  model.joint_types[3] = JointType::kPrismatic;
  model.gains = {1.0, -1.0, 0.5, -2.0, 1.0, 1.0};
  model.masses[2] = {20.0, {0.25, 0.0, 0.1}};
  model.masses[4] = {10.0, {0.0, 0.02, -0.15}};
  model.masses[7] = {1.0, {0.0, 0.03, -0.1}};
  model.ripple_periods_per_turn = {118.0, 33.3, 0.0, 96.0, 60.0, 48.0};  // one of a prismatic joint
  return model;
}

TEST(KinematicModel, ChainIsTheProductOfTheFrameTransforms) {
  const KinematicModel model = mixed_arm();
  const JointVector joints = some_joints(0.1);
  const Chain chain = forward_chain(model, joints);
  Eigen::Isometry3d product = Eigen::Isometry3d::Identity();
  for (std::size_t frame = 0; frame < kFrameCount; ++frame) {
    LinkParameters link = model.links[frame];
    if (frame >= 1 && frame <= 6) {
      double& moved = model.joint_types[frame - 1] == JointType::kPrismatic ? link.r_m : link.theta_rad;
      moved += model.gains[frame - 1] * joints[static_cast<Eigen::Index>(frame) - 1];
    }
    product = product * frame_transform(link);
    EXPECT_LT((chain.block_from_frame[frame].matrix() - product.matrix()).norm(), 1e-14) << "frame " << frame;
  }
}

TEST(ErrorParameters, AreThePapersThirtySevenInOrder) {
  const auto& all = error_parameters();
  EXPECT_EQ(all.front().name(), "theta0");
  EXPECT_EQ(all[1].name(), "r0");
  EXPECT_EQ(all[2].name(), "alpha1");
  EXPECT_EQ(all[6].name(), "beta1");
  EXPECT_EQ(all.back().name(), "beta7");
  EXPECT_EQ(error_parameter_index("alpha0"), std::nullopt);
}

/// What one unit of a parameter's step is: one, or what turns a joint by about a radian.
double step_unit(int parameter) {
  const bool is_compliance =
      parameter >= kErrorParameterCount && parameter < nongeometric_index(harmonic_position(0));
  return is_compliance ? 0.01 : 1.0;
}

/// Differences of a point that is fixed in a frame, by all parameters of the arm.
Eigen::Matrix<double, 3, kArmParameterCount> numeric_derivatives(const KinematicModel& model,
                                                                 const JointVector& joints,
                                                                 const Eigen::Vector3d& point_in_frame_m,
                                                                 std::size_t frame) {
  Eigen::Matrix<double, 3, kArmParameterCount> derivatives;
  for (int i = 0; i < kArmParameterCount; ++i) {
    derivatives.col(i) = numeric_derivative([&](double h) -> Eigen::Vector3d {
      const KinematicModel changed = apply(model, h * step_unit(i) * ArmVector::Unit(i));
      return forward_chain(changed, joints).block_from_frame[frame] * point_in_frame_m;
    });
    derivatives.col(i) /= step_unit(i);
  }
  return derivatives;
}

TEST(ArmParameters, DerivativesMatchDifferencesForARigidArm) {
  KinematicModel paper_arm = apply(paper::nominal(), paper::table3());
  paper_arm.masses = mixed_arm().masses;
  for (const KinematicModel& model : {paper_arm, mixed_arm()}) {
    for (const double shift : {0.0, 0.5}) {
      const JointVector joints = some_joints(shift);
      const auto derivatives = tip_arm_derivatives(model, forward_chain(model, joints));
      const auto numeric = numeric_derivatives(model, joints, Eigen::Vector3d::Zero(), kFrameCount - 1);
      for (int i = 0; i < kArmParameterCount; ++i) {
        EXPECT_LT((derivatives.col(i) - numeric.col(i)).norm() * step_unit(i), 1e-9) << arm_parameter_name(i);
        const bool without_effect = numeric.col(i).norm() * step_unit(i) < 1e-9;
        // Masses turn no joint of a rigid arm; joint 1 of an upright one carries no moment.
        const bool is_mass =
            i >= nongeometric_index(mass_position(1)) && i < nongeometric_index(second_harmonic_position(0));
        const std::string name = arm_parameter_name(i);
        if (i < kErrorParameterCount) {
          EXPECT_EQ(without_effect, name == "theta7") << name;
        } else if (is_mass) {
          EXPECT_TRUE(without_effect) << name;
        }
      }
    }
  }
}

TEST(ArmParameters, DerivativesOfACompliantArmByItsMassesMatchDifferences) {
  KinematicModel model = mixed_arm();
  model.compliance_rad_per_nm = {1e-6, 3e-6, 2e-6, 0.0, 5e-6, 8e-6};
  const JointVector joints = some_joints(0.2);
  const auto derivatives = tip_arm_derivatives(model, forward_chain(model, joints));
  const auto numeric = numeric_derivatives(model, joints, Eigen::Vector3d::Zero(), kFrameCount - 1);
  for (const int frame : {2, 4, 7}) {
    const int i = nongeometric_index(mass_position(frame));
    EXPECT_GT(numeric.col(i).norm(), 1e-6) << frame;
    EXPECT_LT((derivatives.col(i) - numeric.col(i)).norm(), 0.01 * numeric.col(i).norm()) << frame;
  }
}

TEST(KinematicModel, AHarmonicTurnsItsJointByTheSineOfItsPosition) {
  const KinematicModel even = paper::nominal();
  KinematicModel eccentric = even;
  eccentric.harmonics_rad[2] = {3e-4, -2e-4};
  const JointVector joints = some_joints(0.2);
  JointVector where_it_stands = joints;
  where_it_stands[2] += 3e-4 * std::cos(joints[2]) - 2e-4 * std::sin(joints[2]);
  EXPECT_LT(
      (forward_kinematics(eccentric, joints).matrix() - forward_kinematics(even, where_it_stands).matrix())
          .norm(),
      1e-14);
}

TEST(KinematicModel, ASecondHarmonicTurnsItsJointByTheSineOfTwiceItsAngle) {
  KinematicModel even = paper::nominal();
  even.gains[1] = -0.5;
  KinematicModel oval = even;
  oval.second_harmonics_rad[1] = {3e-4, -2e-4};
  const JointVector joints = some_joints(0.2);
  const double angle = -0.5 * joints[1];
  JointVector where_it_stands = joints;
  where_it_stands[1] += 3e-4 * std::cos(2.0 * angle) - 2e-4 * std::sin(2.0 * angle);
  const Eigen::Matrix4d wanted = forward_kinematics(even, where_it_stands).matrix();
  EXPECT_LT((forward_kinematics(oval, joints).matrix() - wanted).norm(), 1e-14);
  EXPECT_GT((forward_kinematics(even, joints).matrix() - wanted).norm(), 1e-5);
}

TEST(KinematicModel, ARippleTurnsItsJointByTheSineOfItsPeriods) {
  const KinematicModel even = paper::nominal();
  KinematicModel rippled = even;
  rippled.gains[3] = -0.5;
  rippled.ripple_periods_per_turn[3] = 71.5;
  rippled.ripples_rad[3] = {3e-5, -2e-5};
  KinematicModel with_gain = even;
  with_gain.gains[3] = -0.5;
  const JointVector joints = some_joints(0.2);
  const double phase = 71.5 * -0.5 * joints[3];
  JointVector where_it_stands = joints;
  where_it_stands[3] += 3e-5 * std::cos(phase) - 2e-5 * std::sin(phase);
  const Eigen::Matrix4d wanted = forward_kinematics(with_gain, where_it_stands).matrix();
  EXPECT_LT((forward_kinematics(rippled, joints).matrix() - wanted).norm(), 1e-14);
  EXPECT_GT((forward_kinematics(with_gain, joints).matrix() - wanted).norm(), 1e-6);
}

TEST(ArmParameters, RipplesHaveNoEffectWithoutTheirPeriods) {
  const KinematicModel model = paper::nominal();
  const JointVector joints = some_joints(0.2);
  const auto derivatives = tip_arm_derivatives(model, forward_chain(model, joints));
  EXPECT_TRUE(derivatives.rightCols(2 * kJointCount).isZero(0.0));
  const KinematicModel changed = apply(model, 1e-3 * ArmVector::Unit(nongeometric_index(ripple_position(2))));
  EXPECT_EQ(forward_kinematics(changed, joints).matrix(), forward_kinematics(model, joints).matrix());
}

TEST(NongeometricParameters, HaveTheirPlacesInTheList) {
  const auto& all = nongeometric_parameters();
  const auto name_at = [&](int position) { return all[static_cast<std::size_t>(position)].name(); };
  EXPECT_EQ(name_at(compliance_position(1)), "compliance2");
  EXPECT_EQ(name_at(harmonic_position(0)), "harmonic_cos1");
  EXPECT_EQ(name_at(harmonic_position(5) + 1), "harmonic_sin6");
  EXPECT_EQ(name_at(mass_position(7)), "mass7");
  EXPECT_EQ(name_at(ripple_position(0)), "ripple_cos1");
  EXPECT_EQ(name_at(ripple_position(5) + 1), "ripple_sin6");
  EXPECT_EQ(ripple_position(5) + 1, kNongeometricCount - 1);
  for (int position = 0; position < kNongeometricCount; ++position) {
    const std::string name = name_at(position);
    EXPECT_EQ(is_harmonic(position), name.starts_with("harmonic")) << name;
    EXPECT_EQ(is_ripple(position), name.starts_with("ripple")) << name;
  }
}

TEST(ArmParameters, DerivativesOfACompliantArmAreWrongByNoMoreThanItsDeflection) {
  KinematicModel model = mixed_arm();
  model.compliance_rad_per_nm[1] = 3e-6;
  model.compliance_rad_per_nm[2] = 2e-6;
  const JointVector joints = some_joints(0.2);
  const Chain chain = forward_chain(model, joints);
  // No moment of gravity, nor its slope by an angle, is larger than all the weight at the end of the
  // stretched arm.
  double mass_kg = 0.0, reach_m = 0.0;
  for (const PointMass& mass : model.masses) mass_kg += mass.mass_kg;
  for (std::size_t frame = 2; frame < kFrameCount; ++frame) {
    reach_m += (chain.block_from_frame[frame].translation() - chain.block_from_frame[frame - 1].translation())
                   .norm();
  }
  const double deflection_rad =
      (model.compliance_rad_per_nm[1] + model.compliance_rad_per_nm[2]) * mass_kg * kFreeFall * reach_m;
  ASSERT_LT(deflection_rad, 5e-3);

  const auto derivatives = tip_arm_derivatives(model, chain);
  const auto numeric = numeric_derivatives(model, joints, Eigen::Vector3d::Zero(), kFrameCount - 1);
  for (int i = 0; i < kArmParameterCount; ++i) {
    const bool is_compliance = step_unit(i) < 1.0;
    const double arm_m = is_compliance ? reach_m * mass_kg * kFreeFall * reach_m : reach_m;
    EXPECT_LT((derivatives.col(i) - numeric.col(i)).norm(), deflection_rad * arm_m) << arm_parameter_name(i);
  }
  // Where the block stands changes no moment.
  EXPECT_LT((derivatives - numeric).leftCols(7).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(ArmParameters, RowOfADistanceIsTheTipsDerivativesAlongTheNormal) {
  KinematicModel model = mixed_arm();
  model.compliance_rad_per_nm[1] = 3e-6;
  const Chain chain = forward_chain(model, some_joints(0.3));
  const Eigen::Vector3d outward = Eigen::Vector3d(1.0, -2.0, 3.0).normalized();
  const ArmRow expected = outward.transpose() * tip_arm_derivatives(model, chain);
  const ArmRow row = distance_derivatives(model, chain, outward);
  EXPECT_LT((row - expected).norm(), 1e-13 * expected.norm());
  EXPECT_EQ(distance_derivatives(prepare(model), chain, outward), row);
}

TEST(ArmParameters, PointOnAnEarlierFrameIsNotMovedByTheFramesAfterIt) {
  const KinematicModel model = mixed_arm();
  const JointVector joints = some_joints(0.1);
  const Chain chain = forward_chain(model, joints);
  const Eigen::Vector3d tool_in_frame_m(0.12, -0.05, 0.2);
  for (const int last_frame : {1, 2, 6}) {
    const auto frame = static_cast<std::size_t>(last_frame);
    const auto derivatives =
        point_arm_derivatives(model, chain, chain.block_from_frame[frame] * tool_in_frame_m, last_frame);
    const auto numeric = numeric_derivatives(model, joints, tool_in_frame_m, frame);
    for (int i = 0; i < kArmParameterCount; ++i) {
      EXPECT_LT((derivatives.col(i) - numeric.col(i)).norm() * step_unit(i), 1e-9)
          << arm_parameter_name(i) << ", frame " << last_frame;
      if (i < kErrorParameterCount && error_parameters()[static_cast<std::size_t>(i)].frame > last_frame) {
        EXPECT_EQ(derivatives.col(i).norm(), 0.0) << arm_parameter_name(i);
      }
    }
  }
}

/// In how many directions the parameters of the block's pose displace and turn the whole arm.
Eigen::Index directions_of_the_place(const KinematicModel& model) {
  std::vector<int> place;
  for (int i = 0; i < kErrorParameterCount; ++i)
    if (group_on(model, i) == ParameterGroup::kBlockPose) place.push_back(i);
  Eigen::MatrixXd of_tips(12, std::ssize(place));
  for (int posture = 0; posture < 4; ++posture) {
    const Chain chain = forward_chain(prepare(model), some_joints(0.4 * posture));
    of_tips.middleRows<3>(3 * posture) = tip_derivatives(model, chain)(Eigen::all, place);
  }
  return rank(of_tips, 1e-6);
}

TEST(ParameterGroup, ThePlaceOfTheBlockHasAllSixDirectionsWhicheverWayJoint1Stands) {
  const int beta1 = error_parameter_index("beta1").value();
  for (const double alpha_rad : {0.0, 0.3, 1.5707963, 3.1415927}) {
    KinematicModel model = paper::nominal();
    model.links[1].alpha_rad = alpha_rad;
    EXPECT_EQ(directions_of_the_place(model), 6) << alpha_rad;
    const bool is_tilt = alpha_rad != 1.5707963;
    EXPECT_EQ(group_on(model, beta1), is_tilt ? ParameterGroup::kBlockPose : ParameterGroup::kArm)
        << alpha_rad;
    for (int i = 0; i < kErrorParameterCount; ++i) {
      if (i == beta1) continue;
      EXPECT_EQ(group_on(model, i), error_parameters()[static_cast<std::size_t>(i)].group());
    }
  }
}

}  // namespace
}  // namespace calib
