#include "service/run/straight_line_targets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "config/truth.hpp"
#include "service/run/compensated_targets.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using calib::CompensationStatus;
using calib::LineReason;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Cell& demo_of_lines() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/demo/cell.json");
  return cell;
}

calib::JointVector joints_deg(double j1, double j4 = 10.0, double j5 = 50.0, double j6 = -20.0) {
  return calib::kRadiansPerDegree * (calib::JointVector() << j1, 30.0, 60.0, j4, j5, j6).finished();
}
Target joint_to(const std::string& name, const calib::JointVector& joints) {
  return {.name = name, .wanted = joints};
}
Target line_to(const std::string& name, const calib::JointVector& joints) {
  return {.name = name, .wanted = joints, .move = TargetMove::kLine};
}

class StraightLineTargets : public ::testing::Test {
 protected:
  std::vector<PathTarget> path_of(const std::vector<Target>& targets,
                                  double limit_m = calib::kLineDeviationMaxMetres) {
    return compensated_path(demo_of_lines(), arm_, tool_, {.version = 2, .targets = targets}, limit_m,
                            "t.json");
  }
  void expect_refused(const std::vector<Target>& targets, const std::string& pointer, const std::string& part,
                      double limit_m = calib::kLineDeviationMaxMetres) {
    const ConfigError error = error_of([&] { path_of(targets, limit_m); });
    EXPECT_EQ(error.source(), "t.json");
    EXPECT_EQ(error.pointer(), pointer);
    EXPECT_THAT(error.message(), HasSubstr(part));
  }
  static std::vector<std::string> names_of(const std::vector<PathTarget>& path) {
    std::vector<std::string> names;
    for (const PathTarget& target : path) names.push_back(target.name);
    return names;
  }

  Arm arm_ = [] {
    Arm arm = demo_of_lines().arm;
    arm.model = true_model(read_truth(kSourceDir / "config/cells/demo/truth-real.json"), arm);
    return arm;
  }();
  calib::CompensationTool tool_ = tool_named(demo_of_lines(), arm_, "gripper", "t", "");
};

TEST_F(StraightLineTargets, HaveTheirPointsBeforeTheirEnd) {
  const auto path =
      path_of({joint_to("a", joints_deg(20)), line_to("b", joints_deg(-10)), joint_to("c", joints_deg(30))});
  ASSERT_GE(path.size(), 8U);
  EXPECT_EQ(path.front().name, "a");
  EXPECT_EQ(path[1].name, "b.1");
  EXPECT_EQ(path[2].name, "b.2");
  EXPECT_EQ(path[path.size() - 2].name, "b");
  EXPECT_EQ(path.back().name, "c");
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_EQ(path[i].is_inserted, i > 0 && i + 2 < path.size());
    EXPECT_TRUE(path[i].result.joints);
  }
  const PathTarget& end = path[path.size() - 2];
  EXPECT_EQ(end.line_from, "a");
  ASSERT_TRUE(end.line);
  EXPECT_LE(end.line->deviation_m, calib::kLineDeviationMaxMetres);
  EXPECT_GT(end.line->unsplit_deviation_m, calib::kLineDeviationMaxMetres);
  EXPECT_TRUE(path.back().line_from.empty());
}

TEST_F(StraightLineTargets, OfAPoseAreAsThoseOfItsJoints) {
  const calib::Compensation compensation = compensation_in(demo_of_lines(), arm_);
  const auto pose_of = [&](const calib::JointVector& joints) {
    return PoseTarget{compensation.nominal_world_from_tool(tool_, joints), joints};
  };
  const auto by_joints = path_of({joint_to("a", joints_deg(20)), line_to("b", joints_deg(0))});
  const auto by_poses = path_of({{.name = "a", .wanted = pose_of(joints_deg(20))},
                                 {.name = "b", .wanted = pose_of(joints_deg(0)), .move = TargetMove::kLine}});
  ASSERT_EQ(by_joints.size(), by_poses.size());
  for (std::size_t i = 0; i < by_joints.size(); ++i)
    EXPECT_TRUE(by_joints[i].result.joints->isApprox(*by_poses[i].result.joints, 1e-9));
}

TEST_F(StraightLineTargets, WithinTheLimitNeedNoPoints) {
  EXPECT_THAT(names_of(path_of({joint_to("a", joints_deg(20)), line_to("b", joints_deg(-10))}, 0.01)),
              ElementsAre("a", "b"));
  const auto same = path_of({joint_to("a", joints_deg(20)), line_to("b", joints_deg(20))});
  ASSERT_EQ(same.size(), 2U);
  EXPECT_LT(same[1].line->deviation_m, calib::kCompensationResidualMax) << "a line of no length";
}

TEST_F(StraightLineTargets, ThatCannotBeHeldRefuseTheirEndAndTheNextLineIsNotJudged) {
  const auto path =
      path_of({joint_to("a", joints_deg(20, 0, 20, 0)), line_to("through", joints_deg(20, 180, 20, -180)),
               line_to("next", joints_deg(20, 180, 25, -180))});
  ASSERT_THAT(names_of(path), ElementsAre("a", "through", "next"));
  EXPECT_EQ(path[1].result.status, CompensationStatus::kRefused);
  EXPECT_FALSE(path[1].result.joints || path[1].result.residual_m || path[1].result.tip_std_m);
  EXPECT_TRUE(path[1].result.moved_m);
  EXPECT_NE(path[1].line->reason, LineReason::kNone);
  EXPECT_EQ(path[2].result.status, CompensationStatus::kWarned);
  EXPECT_EQ(path[2].line_from, "through");
  EXPECT_TRUE(path[2].result.joints);
  EXPECT_FALSE(path[2].line);
}

TEST_F(StraightLineTargets, WhoseEndIsRefusedAreNotJudged) {
  const auto path = path_of({joint_to("a", joints_deg(20)), line_to("wrist", joints_deg(20, 10, 0.5))});
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[1].result.reason, calib::CompensationReason::kStraightWrist);
  EXPECT_FALSE(path[1].line);
}

TEST_F(StraightLineTargets, RefuseNamesThatTheirPointsCannotHave) {
  expect_refused({joint_to("b.2", joints_deg(20)), line_to("b", joints_deg(-10))}, "/targets/1/name",
                 "needs a point \"b.2\" on its straight line, but a target has that name");
  const std::string long_name(kTargetNameSizeMax - 1, 'n');
  expect_refused({joint_to("a", joints_deg(20)), line_to(long_name, joints_deg(-10))}, "/targets/1/name",
                 "would have 65 bytes");
  EXPECT_EQ(path_of({joint_to("a", joints_deg(20)), line_to(long_name, joints_deg(-10))}, 0.01).size(), 2U)
      << "a line without points has no names to give";
}

TEST_F(StraightLineTargets, CountTowardsTheBoundOfTargets) {
  std::vector<Target> targets;
  targets.reserve(kTargetCountMax);
  for (std::size_t i = 0; i + 1 < kTargetCountMax; ++i)
    targets.push_back(joint_to("p" + std::to_string(i), joints_deg(20)));
  targets.push_back(line_to("end", joints_deg(-10)));
  expect_refused(targets, "/targets/99999/move", "more than 100000 targets and points; split the file");
}

TEST(LineMax, IsWhatIsGivenElseTheFilesElseTheDefault) {
  EXPECT_EQ(line_max_m({.version = 2}, std::nullopt), calib::kLineDeviationMaxMetres);
  EXPECT_EQ(line_max_m({.version = 2, .line_max_m = 1e-4}, std::nullopt), 1e-4);
  EXPECT_EQ(line_max_m({.version = 2, .line_max_m = 1e-4}, 2e-4), 2e-4);
}

}  // namespace
}  // namespace cell
