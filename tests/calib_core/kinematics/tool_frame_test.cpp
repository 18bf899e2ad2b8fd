#include "calib_core/kinematics/tool_frame.hpp"

#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

/// In the R_6 of the arm as it is without a tool.
Eigen::Isometry3d tool_of(const KinematicModel& bare, const KinematicModel& mounted,
                          const JointVector& joints) {
  return forward_chain(bare, joints).block_from_frame[kJointCount].inverse() *
         forward_kinematics(mounted, joints);
}

Eigen::Isometry3d turned(double x_deg, double y_deg, double z_deg, const Eigen::Vector3d& point_m) {
  Eigen::Isometry3d tool(Eigen::Translation3d{point_m});
  tool.rotate(Eigen::AngleAxisd(radians_from_degrees(x_deg), Eigen::Vector3d::UnitX()));
  tool.rotate(Eigen::AngleAxisd(radians_from_degrees(y_deg), Eigen::Vector3d::UnitY()));
  tool.rotate(Eigen::AngleAxisd(radians_from_degrees(z_deg), Eigen::Vector3d::UnitZ()));
  return tool;
}

/// z perpendicular to that of R_6 and the point in their plane, without any rounding.
Eigen::Isometry3d across() {
  Eigen::Isometry3d tool(Eigen::Translation3d(0.1, 0.0, 0.2));
  tool.linear() << 0, 0, 1, 0, 1, 0, -1, 0, 0;
  return tool;
}

class MountedTool : public ::testing::TestWithParam<Eigen::Isometry3d> {
 protected:
  MountedTool() {
    joints_ << 0.3, -0.4, 1.2, 0.7, 0.9, -1.1;
    mount_tool(mounted_, GetParam());
  }
  const KinematicModel bare_ = paper::nominal();
  KinematicModel mounted_ = bare_;
  JointVector joints_;
};

TEST_P(MountedTool, StandsInFrame6AsGiven) {
  EXPECT_TRUE(tool_of(bare_, mounted_, joints_).isApprox(GetParam(), 1e-12));
}

TEST_P(MountedTool, IsReachedByTheClosedForm) {
  const Eigen::Isometry3d pose = forward_kinematics(mounted_, joints_);
  const auto found = inverse_kinematics(mounted_, tx90::joint_ranges(), pose);
  ASSERT_FALSE(found.empty());
  for (const JointVector& joints : found)
    EXPECT_TRUE(forward_kinematics(mounted_, joints).isApprox(pose, 1e-9));
}

INSTANTIATE_TEST_SUITE_P(ToolFrame, MountedTool,
                         ::testing::Values(turned(0, 0, 0, {0, 0, 0.25}), turned(0, 0, 0, {0.05, 0, 0.2}),
                                           turned(0, 0, 0, {0.0, -0.08, 0.2}), turned(0, 0, 0, {0, 0, 0}),
                                           turned(30, -50, 70, {0.04, 0.09, 0.15}),
                                           turned(0, 90, 0, {0.1, 0.02, 0.1}),
                                           turned(0, 90, 0, {0.1, 0, 0.2}), across(),
                                           turned(180, 0, 45, {-0.03, 0.0, -0.1})));

}  // namespace
}  // namespace calib
