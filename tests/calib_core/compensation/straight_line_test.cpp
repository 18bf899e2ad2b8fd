#include "calib_core/compensation/straight_line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "tests/calib_core/block_study.hpp"
#include "tests/calib_core/paper.hpp"
#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr double kMicrometre = 1e-6;

/// With the errors of a real arm, and masses that bend it.
KinematicModel drooping_arm() {
  UniformChance chance(kSeed);
  KinematicModel model = apply(paper::nominal(), study::draw_errors(chance));
  model.masses[2] = {25.0, {0.18, 0.0, 0.05}};
  model.masses[4] = {20.0, {0.0, 0.0, -0.25}};
  model.compliance_rad_per_nm = {0.0, 0.8e-6, 2.2e-6, 3e-6, 5e-6, 8e-6};
  return model;
}

CompensationProblem problem_of(const KinematicModel& calibrated) {
  return {.nominal = paper::nominal(), .calibrated = calibrated, .joint_ranges = tx90::joint_ranges()};
}

CompensationTool pointed_tool() {
  Eigen::Isometry3d frame6_from_tool = Eigen::Isometry3d::Identity();
  frame6_from_tool.translate(Eigen::Vector3d(0.03, -0.02, 0.25));
  return drawn_tool(frame6_from_tool);
}

JointVector somewhere() { return tx90::degrees(20.0, 30.0, 60.0, 10.0, 50.0, -20.0); }

class StraightLines : public testing::Test {
 protected:
  Eigen::Isometry3d meant(const JointVector& joints) const {
    return compensation_.nominal_world_from_tool(tool_, joints);
  }
  Eigen::Isometry3d moved(const Eigen::Vector3d& by_m) const {
    return Eigen::Translation3d(by_m) * meant(somewhere());
  }
  JointVector commanded(const Eigen::Isometry3d& pose, const JointVector& near) const {
    const CompensatedTarget target = compensation_.at_pose(tool_, pose, near);
    EXPECT_TRUE(target.joints) << "an end of the line is refused for " << static_cast<int>(target.reason);
    return target.joints.value_or(near);
  }
  StraightLine line(const Eigen::Isometry3d& start, const JointVector& near_start,
                    const Eigen::Isometry3d& end, const JointVector& near_end) const {
    return {start, end, commanded(start, near_start), commanded(end, near_end)};
  }
  StraightLine line_by(const Eigen::Vector3d& by_m) const {
    return line(meant(somewhere()), somewhere(), moved(by_m), somewhere());
  }
  StraightLine line_between(const JointVector& start, const JointVector& end) const {
    return line(meant(start), start, meant(end), end);
  }
  LineCorrection corrected(const StraightLine& line, double limit_m = kLineDeviationMaxMetres) const {
    return corrected_line(compensation_, tool_, line, limit_m);
  }
  /// What a line between commanded postures is really off, by samples of its own: largest of 40 in each part.
  double really_off_m(const StraightLine& line, const std::vector<CompensatedTarget>& points) const {
    std::vector<JointVector> path{line.start_joints};
    for (const CompensatedTarget& point : points) path.push_back(point.joints.value());
    path.push_back(line.end_joints);
    const Eigen::Vector3d from_m = line.world_from_start.translation();
    const Eigen::Vector3d along = (line.world_from_end.translation() - from_m).normalized();
    double off_m = 0.0;
    for (std::size_t part = 1; part < path.size(); ++part) {
      const Eigen::Isometry3d a = meant(path[part - 1]), b = meant(path[part]);
      JointVector joints = path[part - 1];
      for (int i = 1; i < 40; ++i) {
        const double share = i / 40.0;
        Eigen::Isometry3d pose(Eigen::Quaterniond(a.linear()).slerp(share, Eigen::Quaterniond(b.linear())));
        pose.translation() = (1.0 - share) * a.translation() + share * b.translation();
        joints = compensation_.nominal_follow(tool_, pose, joints).value();
        const Eigen::Vector3d gap_m =
            compensation_.calibrated_world_from_tool(tool_, joints).translation() - from_m;
        off_m = std::max(off_m, (gap_m - along * along.dot(gap_m)).norm());
      }
    }
    return off_m;
  }

  Compensation compensation_{problem_of(drooping_arm())};
  CompensationTool tool_ = pointed_tool();
};

TEST_F(StraightLines, BowBetweenRightEndsAndAreHeldByPoints) {
  const StraightLine line = line_by({0.0, -0.4, 0.0});
  const LineCorrection result = corrected(line);
  ASSERT_EQ(result.reason, LineReason::kNone);
  EXPECT_GT(result.unsplit_deviation_m, kLineDeviationMaxMetres);
  EXPECT_NEAR(result.unsplit_deviation_m, really_off_m(line, {}), 0.03 * really_off_m(line, {}));
  EXPECT_GE(result.points.size(), 7U);
  EXPECT_LE(result.deviation_m, kLineDeviationMaxMetres);
  EXPECT_NEAR(result.deviation_m, really_off_m(line, result.points), 1.0 * kMicrometre);
  for (std::size_t i = 0; i < 7 && result.points.size() == 7; ++i) {
    const Eigen::Vector3d wanted_m = moved({0.0, -0.05 * static_cast<double>(i + 1), 0.0}).translation();
    const CompensatedTarget& point = result.points[i];
    EXPECT_EQ(point.status, CompensationStatus::kOk);
    EXPECT_LT(
        (compensation_.calibrated_world_from_tool(tool_, *point.joints).translation() - wanted_m).norm(),
        kCompensationResidualMax);
  }
}

TEST_F(StraightLines, GrowWithTheSquareOfTheirLength) {
  const double short_m = corrected(line_by({0.0, -0.1, 0.0}), 1.0).unsplit_deviation_m;
  const double long_m = corrected(line_by({0.0, -0.2, 0.0}), 1.0).unsplit_deviation_m;
  EXPECT_NEAR(long_m / short_m, 4.0, 1.0);
}

TEST_F(StraightLines, NeedNoPointsWithinTheLimitNorOfAnArmWithoutErrors) {
  const StraightLine line = line_by({0.0, -0.4, 0.0});
  const LineCorrection wide = corrected(line, 0.01);
  EXPECT_TRUE(wide.points.empty());
  EXPECT_EQ(wide.deviation_m, wide.unsplit_deviation_m);
  compensation_ = Compensation(problem_of(paper::nominal()));
  const LineCorrection exact = corrected(line_by({0.0, -0.4, 0.0}));
  EXPECT_EQ(exact.reason, LineReason::kNone);
  EXPECT_TRUE(exact.points.empty());
  EXPECT_LT(exact.deviation_m, 1e-9);
}

TEST_F(StraightLines, HalveOnlyThePartsThatStillBow) {
  const StraightLine line = line_by({0.0, -0.4, 0.0});
  const LineCorrection result = corrected(line, 0.5 * kMicrometre);
  ASSERT_EQ(result.reason, LineReason::kNone);
  EXPECT_GT(result.points.size(), 7U);
  EXPECT_LE(result.deviation_m, 0.5 * kMicrometre);
  const LineCorrection never = corrected(line, 1e-12);
  EXPECT_EQ(never.reason, LineReason::kStaysOff);
  EXPECT_GT(never.deviation_m, 1e-12);
  EXPECT_TRUE(never.points.empty());
}

TEST_F(StraightLines, OfNoLengthAreThePlaceThatTheToolTurnsAbout) {
  const LineCorrection nothing = corrected(line_by(Eigen::Vector3d::Zero()));
  EXPECT_EQ(nothing.reason, LineReason::kNone);
  EXPECT_TRUE(nothing.points.empty());
  EXPECT_LT(nothing.deviation_m, kCompensationResidualMax);
  const Eigen::Isometry3d start = meant(somewhere());
  const Eigen::Isometry3d end = start * Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX());
  const LineCorrection turned = corrected(line(start, somewhere(), end, somewhere()));
  ASSERT_EQ(turned.reason, LineReason::kNone);
  EXPECT_GT(turned.unsplit_deviation_m, kLineDeviationMaxMetres);
  EXPECT_FALSE(turned.points.empty());
  EXPECT_LE(turned.deviation_m, kLineDeviationMaxMetres);
}

TEST_F(StraightLines, BetweenTwoConfigurationsAreNone) {
  JointVector flipped = somewhere();
  flipped[3] -= std::numbers::pi;
  flipped[4] = -flipped[4];
  flipped[5] += std::numbers::pi;
  EXPECT_EQ(corrected(line_between(somewhere(), flipped)).reason, LineReason::kOtherConfiguration);
}

TEST_F(StraightLines, ThroughAStraightWristAreNone) {
  const JointVector start = tx90::degrees(20.0, 30.0, 60.0, 0.0, 20.0, 0.0);
  // The same wrist on its other side, written with joint 5 positive.
  const LineCorrection through =
      corrected(line_between(start, tx90::degrees(20.0, 30.0, 60.0, 180.0, 20.0, -180.0)));
  EXPECT_TRUE(
      through.reason == LineReason::kJointTurnsFar ||
      (through.reason == LineReason::kPosture && through.point.reason == CompensationReason::kStraightWrist))
      << static_cast<int>(through.reason);
  EXPECT_GT(through.share, 0.2);
  EXPECT_LT(through.share, 0.8);
  EXPECT_TRUE(through.points.empty());
}

TEST_F(StraightLines, ThatPassTheAxisOfJoint1AreNone) {
  const JointVector near = tx90::degrees(0.0, -20.0, 130.0, 0.0, 70.0, 0.0);
  const Eigen::Isometry3d there = meant(near);
  const double x_m = there.translation().x();
  const Eigen::Isometry3d beyond =
      Eigen::AngleAxisd(std::numbers::pi * 0.9, Eigen::Vector3d::UnitZ()) * there;
  JointVector turned = near;
  turned[0] += std::numbers::pi * 0.9;
  ASSERT_GT(std::abs(x_m), 0.05);
  EXPECT_NE(corrected(line(there, near, beyond, turned)).reason, LineReason::kNone);
}

TEST_F(StraightLines, ThatEndAFullTurnAwayAreNone) {
  JointVector end = somewhere();
  end[5] += 2.0 * std::numbers::pi - 0.1;
  ASSERT_LT(end[5], tx90::joint_ranges().upper[5] + 1.6);
  JointVector start = somewhere();
  start[5] -= 2.0;
  end[5] -= 2.0;
  const LineCorrection result = corrected(line_between(start, end));
  EXPECT_EQ(result.reason, LineReason::kOtherTurns);
  EXPECT_EQ(result.joint, 6);
}

TEST_F(StraightLines, OnWhichTheToolTurnsHalfwayRoundAreNone) {
  JointVector end = somewhere();
  end[5] += std::numbers::pi;
  const LineCorrection result = corrected(line_between(somewhere(), end));
  EXPECT_EQ(result.reason, LineReason::kHalfTurn);
  EXPECT_NEAR(result.angle_rad, std::numbers::pi, 1e-6);
}

TEST_F(StraightLines, OnWhichAJointLeavesItsRangeAreNone) {
  // Across before the arm: in the middle the elbow is bent most.
  const JointVector side = tx90::degrees(40.0, 30.0, 60.0, 0.0, 60.0, 0.0);
  JointVector other = side;
  other[0] = -side[0];
  const LineCorrection free = corrected(line_between(side, other));
  ASSERT_EQ(free.reason, LineReason::kNone);
  ASSERT_FALSE(free.points.empty());
  CompensationProblem narrow = problem_of(drooping_arm());
  narrow.joint_ranges.upper[2] = side[2] + 0.05;
  compensation_ = Compensation(narrow);
  const LineCorrection result = corrected(line_between(side, other));
  ASSERT_EQ(result.reason, LineReason::kPosture);
  EXPECT_EQ(result.point.reason, CompensationReason::kOutOfRange);
  EXPECT_EQ(result.point.joint, 3);
  EXPECT_GT(result.share, 0.0);
  EXPECT_LT(result.share, 0.5);
}

}  // namespace
}  // namespace calib
