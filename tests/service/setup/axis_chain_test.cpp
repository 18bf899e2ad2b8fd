#include "service/setup/axis_chain.hpp"

#include <gtest/gtest.h>

#include <random>

#include "calib_core/geometry/units.hpp"

namespace cell {
namespace {

using calib::JointVector;
using calib::kJointCount;
using Axes = std::array<JointAxis, kJointCount>;

/// By the exponentials of the axes: nothing of the links is in it.
Eigen::Isometry3d product_of_turns(const Axes& axes, const Eigen::Isometry3d& base_from_tip,
                                   const JointVector& joints) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < axes.size(); ++i)
    pose = pose * Eigen::Translation3d(axes[i].point_m) *
           Eigen::AngleAxisd(joints[static_cast<Eigen::Index>(i)], axes[i].direction) *
           Eigen::Translation3d(-axes[i].point_m);
  return pose * base_from_tip;
}

void expect_same(const Axes& axes, const Eigen::Isometry3d& tip, std::mt19937_64& chance) {
  const calib::KinematicModel model = model_of_axes(axes, tip);
  std::uniform_real_distribution<double> turn(-3.0, 3.0);
  for (int i = 0; i < 20; ++i) {
    JointVector joints;
    for (double& joint : joints) joint = turn(chance);
    const Eigen::Isometry3d theirs = product_of_turns(axes, tip, joints);
    const Eigen::Isometry3d ours = calib::forward_kinematics(model, joints);
    EXPECT_LT((theirs.translation() - ours.translation()).norm(), calib::kPositionErrorMaxMetres);
    EXPECT_LT((theirs.linear() - ours.linear()).norm(), 1e-9);
  }
}

Eigen::Isometry3d tip_at(const Eigen::Vector3d& point_m, const Eigen::Quaterniond& turn) {
  return Eigen::Translation3d(point_m) * turn.normalized();
}

TEST(AxisChain, HasThePosesOfRandomAxes) {
  std::mt19937_64 chance(11);
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  const auto random = [&] { return Eigen::Vector3d(within(chance), within(chance), within(chance)); };
  for (int arm = 0; arm < 50; ++arm) {
    SCOPED_TRACE(arm);
    Axes axes;
    for (JointAxis& axis : axes) axis = {random(), random().normalized()};
    expect_same(axes, tip_at(random(), {within(chance), within(chance), within(chance), within(chance)}),
                chance);
  }
}

/// Axes that are parallel, opposite, the same or meet in a point, exactly and but for the rounding of a file.
TEST(AxisChain, HasThePosesOfAxesThatAreParallelOrMeet) {
  std::mt19937_64 chance(12);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (const double rounding : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-4, 0.02, 0.099, 0.101}) {
    SCOPED_TRACE(rounding);
    const auto off = [&] {
      return Eigen::Vector3d(rounding * Eigen::Vector3d(noise(chance), noise(chance), noise(chance)));
    };
    const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), y = Eigen::Vector3d::UnitY();
    Axes axes{JointAxis{{0.0, 0.0, 0.1}, z},  JointAxis{{0.1, 0.2, 0.5}, y},  JointAxis{{0.1, 0.1, 0.9}, -y},
              JointAxis{{0.5, 0.1, 0.9}, -y}, JointAxis{{0.6, 0.0, 0.9}, -z}, JointAxis{{0.6, 0.0, 0.7}, z}};
    for (JointAxis& axis : axes) axis = {axis.point_m + 0.1 * off(), (axis.direction + off()).normalized()};
    const calib::KinematicModel model = model_of_axes(axes, tip_at({0.6, 0.0, 0.5}, {0.0, 1.0, 0.0, 0.0}));
    for (const calib::LinkParameters& link : model.links)
      EXPECT_LT(std::hypot(link.d_m, link.r_m), 20.0) << "no length grows";
    expect_same(axes, tip_at({0.6, 0.0, 0.5}, {0.0, 1.0, 0.0, 0.0}), chance);
  }
}

}  // namespace
}  // namespace cell
