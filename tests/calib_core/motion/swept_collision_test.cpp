#include "calib_core/motion/swept_collision.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "tests/calib_core/tx90.hpp"

namespace calib {
namespace {

constexpr double kSweepClearanceMetres = 0.012;

/// Clashes at a very fine sampling of the move: no body goes farther than 0.5 mm between two looks.
bool sampled_clash(const CollisionScene& scene, const JointVector& from, const JointVector& to,
                   double clearance_m) {
  const double farthest_m = (to - from).cwiseAbs().sum() * 1.3;
  const int steps = static_cast<int>(farthest_m / 0.0005) + 1;
  for (int i = 0; i <= steps; ++i) {
    const JointVector joints = from + (to - from) * i / steps;
    if (find_clash(scene, forward_chain(paper::nominal(), joints), clearance_m)) return true;
  }
  return false;
}

/// A shelf as thin as paper in the arm's way, so that a coarse sampling would step over it, a ball and a
/// ring.
CollisionScene scene_with_shelf() {
  CollisionScene scene = tx90::scene(0.003);
  scene.obstacles.push_back({"shelf", {-0.3, -0.4001, -0.6}, {0.3, -0.4, 0.6}});
  Box ring{"ring", {0.2, -0.6, -0.3}, {0.6, -0.2, 0.3}};  // with a hole that an arm fits through
  ring.holes.push_back({{0.4, -0.4, 0}, {0, 0, 1}, 0.18});
  scene.obstacles.push_back(ring);
  scene.obstacles.push_back({"ball", {0.1, -0.7, 0.2}, {0.1, -0.7, 0.2}, 0.1});
  return scene;
}

TEST(SweptCollision, FindsWhatAFineSamplingFindsAndNothingElse) {
  const CollisionScene scene = scene_with_shelf();
  const JointRanges ranges{tx90::degrees(-70, -30, 10, -90, -90, -90),
                           tx90::degrees(70, 40, 110, 90, 90, 90)};
  std::mt19937_64 chance(11);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto random_joints = [&] {
    JointVector joints;
    for (double& joint : joints) joint = share(chance);
    return JointVector(ranges.lower + (ranges.upper - ranges.lower).cwiseProduct(joints));
  };
  int clear = 0, clashes = 0;
  while (clear < 6 || clashes < 6) {
    const JointVector from = random_joints(), to = random_joints();
    if (find_clash(scene, forward_chain(paper::nominal(), from), kSweepClearanceMetres)) continue;
    const bool found =
        find_clash_on_move(scene, paper::nominal(), from, to, kSweepClearanceMetres).has_value();
    const double finer_m = kSweepClearanceMetres + (found ? 0.0005 : -kSweptErrorMaxMetres);
    EXPECT_EQ(sampled_clash(scene, from, to, finer_m), found) << from.transpose() << " to " << to.transpose();
    ++(found ? clashes : clear);
  }
}

TEST(SweptCollision, LooksAtBothEnds) {
  const CollisionScene scene = tx90::scene(0.003);
  const JointVector park = tx90::park_joints(), on_table = tx90::degrees(0, 60, 90, 0, 0, 0);
  ASSERT_TRUE(find_clash(scene, forward_chain(paper::nominal(), on_table), 0.0));
  EXPECT_TRUE(find_clash_on_move(scene, paper::nominal(), park, on_table, 0.0));
  EXPECT_TRUE(find_clash_on_move(scene, paper::nominal(), on_table, park, 0.0));
  EXPECT_TRUE(find_clash_on_move(scene, paper::nominal(), on_table, on_table, 0.0));
  EXPECT_FALSE(find_clash_on_move(scene, paper::nominal(), park, park, kSweepClearanceMetres));
}

TEST(SweptCollision, APostureThatIsNotANumberIsNotClear) {
  const JointVector nowhere = JointVector::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(find_clash_on_move(tx90::scene(0.0), paper::nominal(), tx90::park_joints(), nowhere, 0.0));
}

}  // namespace
}  // namespace calib
