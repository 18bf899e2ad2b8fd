#include "calib_core/proof/tool_centre.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "calib_core/kinematics/tool_frame.hpp"
#include "calib_core/proof/detection_planning.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/proof/proved_cell.hpp"
#include "tests/calib_core/qualification/qualified_cell.hpp"

namespace calib {
namespace {

using ::testing::HasSubstr;

Eigen::Isometry3d tool_at(const Eigen::Vector3d& centre_m) {
  return Eigen::Isometry3d(Eigen::Translation3d(centre_m));
}

/// 60 mm off the axis of joint 6, 0.3 to 0.4 mm from its drawing.
const Eigen::Vector3d kDrawnMetres{0.06, 0.0, 0.25};
const Eigen::Vector3d kTrueMetres{0.0603, -0.0004, 0.2503};

class ToolCentreTest : public ::testing::Test {
 protected:
  std::vector<Touch> touches(int count = kToolTouchCount, double noise_m = 0.0) {
    KinematicModel arm = cell_.true_arm();
    mount_tool(arm, tool_at(kTrueMetres));
    return cell_.touches_at(Eigen::Isometry3d::Identity(), arm, count, noise_m);
  }
  std::variant<ToolVerdict, ToolRefusal> find(const std::vector<Touch>& touches,
                                              const ToolLimits& limits = {}) {
    return find_tool_centre(cell_.record(), tip_, touches, postures_, limits);
  }
  ToolVerdict verdict(const std::vector<Touch>& touches, const ToolLimits& limits = {}) {
    const auto outcome = find(touches, limits);
    if (const auto* refusal = std::get_if<ToolRefusal>(&outcome)) throw std::runtime_error(refusal->message);
    return std::get<ToolVerdict>(outcome);
  }
  std::string refusal(const std::vector<Touch>& touches) {
    const auto outcome = find(touches);
    const auto* refusal = std::get_if<ToolRefusal>(&outcome);
    return refusal ? refusal->message : "";
  }
  /// Root mean square over the postures of how far the true tip is from where the calibrated arm has it.
  double off_rms_m(const Eigen::Vector3d& centre_m, const ArmVector& errors = ArmVector::Zero()) const {
    const KinematicModel arm = apply(cell_.record().calibrated(), errors);
    double squares = 0.0;
    for (const JointVector& joints : postures_) {
      const Chain real = forward_chain(cell_.true_arm(), joints);
      const Chain believed = forward_chain(arm, joints);
      squares += (tool_centre_in_block_m(real, tool_at(kTrueMetres)) -
                  tool_centre_in_block_m(believed, tool_at(centre_m)))
                     .squaredNorm();
    }
    return std::sqrt(squares / static_cast<double>(postures_.size()));
  }

  proved::Cell cell_;
  ToolTip tip_{.drawn_m = kDrawnMetres, .noise_m = proved::kNoiseMetres};
  std::vector<JointVector> postures_ = postures_in_box(
      paper::nominal(), tx90::joint_ranges(),
      Box{"box", Eigen::Vector3d(-0.3, -0.5, -0.25), Eigen::Vector3d(0.3, 0.0, 0.55)}, std::nullopt, 100);
};

TEST_F(ToolCentreTest, IsFoundFromEightTouches) {
  const ToolVerdict found = verdict(touches(kToolTouchCount, proved::kNoiseMetres));
  EXPECT_TRUE(found.passed);
  EXPECT_EQ(found.degrees_of_freedom, kToolTouchCount - 3);
  EXPECT_LT(off_rms_m(found.centre_m, found.arm_errors), 0.3 * off_rms_m(kDrawnMetres));
  ASSERT_TRUE(found.rms_over_postures_m);
  EXPECT_LT(off_rms_m(found.centre_m, found.arm_errors), 2.0 * *found.rms_over_postures_m);
}

TEST_F(ToolCentreTest, ItsUncertaintyIsThatOfManyDraws) {
  double squares = 0.0, promised = 0.0;
  constexpr int kDraws = 60;
  for (int i = 0; i < kDraws; ++i) {
    const ToolVerdict found = verdict(touches(kToolTouchCount, proved::kNoiseMetres));
    squares += std::pow(off_rms_m(found.centre_m, found.arm_errors), 2);
    promised += std::pow(*found.rms_over_postures_m, 2);
  }
  // One calibration is one draw of what it left open: the ratio is right within a factor.
  EXPECT_GT(squares, 0.1 * promised);
  EXPECT_LT(squares, 2.5 * promised);
}

TEST_F(ToolCentreTest, RowsAreDerivatives) {
  const std::vector<Touch> made = touches();
  constexpr double kStep = 1e-7;
  const ToolRows rows = tool_rows(cell_.record(), tip_, kDrawnMetres, made);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd moved =
        tool_rows(cell_.record(), tip_, kDrawnMetres + kStep * Eigen::Vector3d::Unit(axis), made).distances_m;
    EXPECT_LT(((moved - rows.distances_m) / kStep - rows.of_centre.col(axis)).norm(), 1e-6) << axis;
  }
}

TEST_F(ToolCentreTest, ALargerTipTouchesFartherOut) {
  const std::vector<Touch> same = touches();
  const Eigen::VectorXd before = tool_rows(cell_.record(), tip_, kDrawnMetres, same).distances_m;
  tip_.larger_m = 1e-3;
  const Eigen::VectorXd after = tool_rows(cell_.record(), tip_, kDrawnMetres, same).distances_m;
  EXPECT_TRUE((before - after).isApproxToConstant(1e-3, 1e-9));
}

TEST_F(ToolCentreTest, ALooseToolAndAMissedLimitFail) {
  std::vector<Touch> made = touches();
  made[2].joints.array() += 1e-3;  // some tenths of a millimetre
  const ToolVerdict loose = verdict(made, {.rms_max_m = 1e-9});
  EXPECT_FALSE(loose.passed);
  ASSERT_EQ(loose.reasons.size(), 2U);
  EXPECT_THAT(loose.reasons[0], HasSubstr("contradict each other"));
  EXPECT_THAT(loose.reasons[1], HasSubstr("more than 0.000 mm"));
}

TEST_F(ToolCentreTest, RefusesWhatIsNoSuchTool) {
  const std::vector<Touch> made = touches();
  EXPECT_THAT(refusal({made.begin(), made.begin() + 4}), HasSubstr("4 touches"));
  auto bad = made;
  bad[1].face = 7;
  EXPECT_THAT(refusal(bad), HasSubstr("touch 2 is on a plane that the block does not have"));
  bad = made;
  bad[3].joints[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(bad), HasSubstr("touch 4 has a joint that is not a number"));
  EXPECT_THAT(refusal(std::vector<Touch>(8, made.front())), HasSubstr("do not determine where the tip is"));
  bad = made;
  bad[5].joints.array() += 0.05;
  EXPECT_THAT(refusal(bad), HasSubstr("off its plane"));
  tip_.drawn_m.z() += 0.03;
  EXPECT_THAT(refusal(made), HasSubstr("another tool is mounted"));
}

TEST_F(ToolCentreTest, IsPlannedBetterThanByChance) {
  PlanningProblem problem = qualified::planning_problem();
  mount_tool(problem.nominal, tool_at(kDrawnMetres));
  std::erase_if(problem.scene.bodies, [](const Capsule& body) { return body.frame == kFrameCount - 1; });
  const auto plan = plan_tool(problem, cell_.record(), tip_);
  ASSERT_TRUE(std::holds_alternative<TouchPlan>(plan)) << std::get<PlanningFailure>(plan).reason;
  std::vector<Touch> planned;
  for (const PlannedTouch& touch : std::get<TouchPlan>(plan).touches)
    planned.push_back({touch.face, touch.joints, touch.role});
  ASSERT_EQ(planned.size(), static_cast<std::size_t>(kToolTouchCount));
  const auto size = [&](const std::vector<Touch>& of) {
    const ToolRows rows = tool_rows(cell_.record(), tip_, kDrawnMetres, of);
    const Eigen::MatrixXd weights = tool_covariance(cell_.record(), tip_, rows, of).inverse();
    return (rows.of_centre.transpose() * weights * rows.of_centre).inverse().trace();
  };
  double by_chance = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 10; ++i) by_chance = std::min(by_chance, size(touches()));
  EXPECT_LT(size(planned), by_chance);
}

}  // namespace
}  // namespace calib
