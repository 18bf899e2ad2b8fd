#include "sim_controller/move_obstacle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drive_runs.hpp"
#include "sim_controller/val3_units.hpp"

namespace sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::plant;
using Shape = val3::MoveOrder::Shape;

constexpr double kWristToFlangeMetres = 0.1;
constexpr val3::Config kFreeConfig{val3::Shoulder::kFree, val3::Elbow::kFree, val3::Wrist::kFree};

class MoveObstacle : public ::testing::Test {
 protected:
  static calib::JointVector joints(const val3::Joint& deg) { return joints_from_val3(deg); }
  /// A move of the bare flange to a pose, as the machine orders it.
  [[nodiscard]] val3::MoveOrder to(Shape shape, const Eigen::Isometry3d& world_from_flange,
                                   const val3::Config& config = kFreeConfig) const {
    val3::MoveOrder order{.shape = shape, .to_pose = val3_from_pose(world_from_flange), .config = config};
    order.reachable = arm_.solve(world_from_flange, config, from_).has_value();
    return order;
  }
  [[nodiscard]] std::string obstacle(const val3::MoveOrder& order) const {
    const auto in_block = [&](const val3::Trsf& pose) {
      return arm_.block_from_world() * pose_from_val3(pose);
    };
    ToolPath way{.path = {from_, joints(order.to)}};
    if (order.shape == Shape::kLine)
      way = line_to_pose(plant(), from_, in_block(order.to_pose), arm_.tip_from_flange());
    if (order.shape == Shape::kCircle)
      way = arc_to_pose(plant(), from_, in_block(order.via_pose), in_block(order.to_pose),
                        arm_.tip_from_flange());
    return move_obstacle(plant(), arm_, order, from_, way);
  }
  [[nodiscard]] Eigen::Isometry3d here() const { return arm_.world_from_flange(from_); }

  const ControllerArm arm_{plant(), kWristToFlangeMetres};
  const calib::JointVector from_ = joints({5, 10, 90, 0, 60, 0});
};

TEST_F(MoveObstacle, NamesTheJointThatIsFarthestBeyondItsRange) {
  const val3::MoveOrder order{.shape = Shape::kJoint, .to = {0, 0, 150, 0, 700, 0}};
  EXPECT_THAT(obstacle(order),
              AllOf(HasSubstr("joint 5 at 700 deg is outside its range from "), HasSubstr(" deg")));
}

TEST_F(MoveObstacle, TellsReachFromConfigurationAndFromRanges) {
  Eigen::Isometry3d far = here();
  far.translation().x() = 3.0;
  EXPECT_EQ(obstacle(to(Shape::kJoint, far)), "the pose is out of reach");
  EXPECT_EQ(obstacle(to(Shape::kLine, far)), "the pose is out of reach");

  // Joint 2 is near the end of its range: the arm turned about and bent over backwards is beyond the other
  // one.
  const Eigen::Isometry3d low = arm_.world_from_flange(joints({5, 140, 20, 0, 60, 0}));
  ASSERT_TRUE(arm_.solve(low, kFreeConfig, from_));
  val3::Config other = kFreeConfig;
  other.shoulder = val3::Shoulder::kRighty;
  ASSERT_FALSE(arm_.solve(low, other, from_));
  EXPECT_EQ(obstacle(to(Shape::kJoint, low, other)),
            "the pose is within reach, but not in the configuration that the point asks for");

  const Eigen::Isometry3d folded = arm_.world_from_flange(joints({5, 10, 160, 0, 60, 0}));
  ASSERT_FALSE(arm_.solve(folded, kFreeConfig, from_));
  EXPECT_THAT(obstacle(to(Shape::kJoint, folded)),
              AllOf(HasSubstr("within reach, but beyond the joint ranges: joint "), HasSubstr("range from")));
}

TEST_F(MoveObstacle, SaysHowFarALineComesAndWhatStopsIt) {
  // Straight through the axis of joint 1, where the tool would have to turn about.
  Eigen::Isometry3d behind = here();
  behind.translation().x() *= -1.0;
  behind.translation().y() *= -1.0;
  const val3::MoveOrder through = to(Shape::kLine, behind);
  ASSERT_TRUE(through.reachable);
  EXPECT_THAT(obstacle(through), HasSubstr("% of the way"));
}

TEST_F(MoveObstacle, ALineEndsInTheConfigurationItBeginsIn) {
  Eigen::Isometry3d near = here();
  near.translation().z() -= 0.02;
  val3::Config other = arm_.config_of(from_);
  other.wrist = val3::Wrist::kNegative;
  EXPECT_THAT(obstacle(to(Shape::kLine, near, other)), HasSubstr("another configuration than its start"));
}

TEST_F(MoveObstacle, ThreePointsOnALineGiveNoArc) {
  Eigen::Isometry3d end = here();
  end.translation().z() -= 0.1;
  val3::MoveOrder order = to(Shape::kCircle, end);
  Eigen::Isometry3d via = here();
  via.translation().z() -= 0.05;
  order.via_pose = val3_from_pose(via);
  EXPECT_THAT(obstacle(order), HasSubstr("the three points give no arc"));
}

TEST_F(MoveObstacle, IsToldWithTheLineThatStoredTheMove) {
  val3::MoveOrder order{.shape = Shape::kLine};
  order.origin = {"main~", "start.pgx", 7};
  EXPECT_EQ(impossible_move_text(order, "why"), "movel at start.pgx:7 of task main~: why");
}

}  // namespace
}  // namespace sim
