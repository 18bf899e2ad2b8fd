#include "calib_core/motion/path_shortcut.hpp"

#include <gtest/gtest.h>

namespace calib {
namespace {

JointVector at(double joint_1, double joint_2) {
  JointVector joints = JointVector::Zero();
  joints.head<2>() << joint_1, joint_2;
  return joints;
}

/// Joints 1 and 2 must keep 1 rad to the origin.
bool is_clear(const JointVector& from, const JointVector& to) {
  const JointVector move = to - from;
  const double length2 = move.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp(-from.dot(move) / length2, 0.0, 1.0) : 0.0;
  return (from + share * move).norm() >= 1.0;
}

double seconds(const JointVector& from, const JointVector& to) { return (to - from).norm(); }

double length(const std::vector<JointVector>& way) {
  double sum = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) sum += seconds(way[i - 1], way[i]);
  return sum;
}

const MoveCriteria kRoundObstacle{is_clear, seconds};

TEST(TightenedWay, IsShorterAndStillClear) {
  const std::vector<JointVector> wide{at(-2, 0), at(-2, 4), at(2, 4), at(2, 0)};
  const std::vector<JointVector> tight = shortcut_path(kRoundObstacle, wide);
  EXPECT_LT(length(tight), 0.75 * length(wide));
  EXPECT_EQ(tight.front(), wide.front());
  EXPECT_EQ(tight.back(), wide.back());
  for (std::size_t i = 1; i < tight.size(); ++i) EXPECT_TRUE(is_clear(tight[i - 1], tight[i])) << i;
}

TEST(TightenedWay, LeavesOutAPostureThatIsNotNeeded) {
  const std::vector<JointVector> tight = shortcut_path(kRoundObstacle, {at(-2, 2), at(0, 5), at(2, 2)});
  EXPECT_EQ(tight, (std::vector{at(-2, 2), at(2, 2)}));
}

TEST(TightenedWay, IsTheGivenOneWhereAShorterOneTakesLonger) {
  const MoveCriteria slow_near_by{is_clear, [](const JointVector& from, const JointVector& to) {
                                    return 100.0 / (1.0 + (from + to).norm());
                                  }};
  const std::vector<JointVector> wide{at(-2, 0), at(0, 4), at(2, 0)};
  EXPECT_EQ(shortcut_path(slow_near_by, wide), wide);
}

TEST(TightenedWay, OfADirectMoveIsTheMove) {
  const std::vector<JointVector> direct{at(-2, 2), at(2, 2)};
  EXPECT_EQ(shortcut_path(kRoundObstacle, direct), direct);
}

}  // namespace
}  // namespace calib
