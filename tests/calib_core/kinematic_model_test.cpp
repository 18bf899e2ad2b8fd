#include "calib_core/kinematic_model.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "calib_core/error_parameters.hpp"
#include "calib_core/units.hpp"
#include "tests/calib_core/paper.hpp"

namespace calib {
namespace {

struct ReferencePose {
  bool table3 = false;
  JointVector joints;
  Eigen::Isometry3d block_from_tip = Eigen::Isometry3d::Identity();
};

/// From an independent program; see the comment on the file's first line.
std::vector<ReferencePose> read_reference_poses() {
  std::ifstream file(TOUCHCAL_SOURCE_DIR "/tests/data/reference_poses.csv");
  std::vector<ReferencePose> poses;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#') || line.starts_with("model")) continue;
    std::istringstream fields(line);
    std::string model;
    std::getline(fields, model, ',');
    std::vector<double> v;
    for (std::string field; std::getline(fields, field, ',');) v.push_back(std::stod(field));
    if (v.size() != 18)
      throw std::runtime_error("reference pose with " + std::to_string(v.size()) + " numbers");
    ReferencePose pose{.table3 = model == "table3"};
    for (int i = 0; i < 6; ++i) pose.joints[i] = radians_from_degrees(v[static_cast<std::size_t>(i)]);
    for (int i = 0; i < 3; ++i)
      pose.block_from_tip.translation()[i] = metres_from_mm(v[static_cast<std::size_t>(6 + i)]);
    for (int i = 0; i < 9; ++i)
      pose.block_from_tip.linear()(i / 3, i % 3) = v[static_cast<std::size_t>(9 + i)];
    poses.push_back(pose);
  }
  return poses;
}

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

TEST(ErrorParameters, AreThePapersThirtySevenInOrder) {
  const auto& all = error_parameters();
  EXPECT_EQ(all.front().name(), "theta0");
  EXPECT_EQ(all[1].name(), "r0");
  EXPECT_EQ(all[2].name(), "alpha1");
  EXPECT_EQ(all[6].name(), "beta1");
  EXPECT_EQ(all.back().name(), "beta7");
  EXPECT_EQ(error_parameter_index("alpha0"), std::nullopt);
}

TEST(ErrorParameters, DerivativesMatchDifferencesForEveryParameter) {
  const KinematicModel model = apply(paper::nominal(), paper::table3());
  for (const double shift : {0.0, 0.5}) {
    const JointVector joints = some_joints(shift);
    const auto derivatives = tip_derivatives(model, forward_chain(model, joints));
    for (int i = 0; i < kErrorParameterCount; ++i) {
      const auto numeric = numeric_derivative([&](double h) -> Eigen::Vector3d {
        return forward_kinematics(apply(model, h * ErrorVector::Unit(i)), joints).translation();
      });
      EXPECT_LT((derivatives.col(i) - numeric).norm(), 1e-9)
          << error_parameters()[static_cast<std::size_t>(i)].name();
    }
  }
}

}  // namespace
}  // namespace calib
