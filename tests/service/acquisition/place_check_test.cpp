#include "service/acquisition/place_check.hpp"

#include <gtest/gtest.h>

#include "service/run/planning_problem.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

/// The block where the cell's file has it, found by the nominal arm's touches of three faces.
class PlaceCheckTest : public ::testing::Test {
 protected:
  PlaceCheckTest() {
    place_.cell_from_block.setIdentity();
    for (const calib::PlannedTouch& touch : plan_of_owners().touches.touches) {
      if (touch.face > 2) continue;
      place_.touches.push_back({touch.face, touch.joints, 1e-4});
    }
  }
  [[nodiscard]] PlaceCheck check() const {
    return {planning_problem(cell_of_owners(), cell_of_owners().recipes.at("few")), place_};
  }
  [[nodiscard]] static calib::Touch met(int face, double off_rad) {
    for (const calib::PlannedTouch& touch : plan_of_owners().touches.touches) {
      if (touch.face != face) continue;
      calib::JointVector joints = touch.joints;
      joints[1] += off_rad;
      joints[2] -= off_rad / 2;
      return {.face = face, .joints = joints};
    }
    throw std::logic_error("no such face");
  }

  BlockPose place_;
};

TEST_F(PlaceCheckTest, ABlockThatStandsThereIsNoFault) {
  PlaceCheck check = this->check();
  for (const int face : {0, 1, 2}) EXPECT_FALSE(check.check(met(face, 0.0))) << face;
}

TEST_F(PlaceCheckTest, AFaceThatIsMetElsewhereSaysSoOnceAFace) {
  PlaceCheck check = this->check();
  EXPECT_EQ(check.check(met(0, 0.1)).value().code, FaultCode::kBlockMoved);
  EXPECT_FALSE(check.check(met(0, 0.1))) << "its first touch counts";
}

TEST_F(PlaceCheckTest, AFaceThatIsNotMetAtAllWasMovedUntilItWasMet) {
  PlaceCheck check = this->check();
  const Fault missed{FaultCode::kNoContact, {}};
  EXPECT_EQ(check.explain(missed, 0).code, FaultCode::kBlockMoved);
  EXPECT_EQ(check.explain({FaultCode::kCollision, {}}, 0).code, FaultCode::kCollision);
  check.check(met(0, 0.0));
  EXPECT_EQ(check.explain(missed, 0).code, FaultCode::kNoContact);
  EXPECT_EQ(check.explain(missed, 1).code, FaultCode::kBlockMoved);
}

TEST_F(PlaceCheckTest, HasNoSayOnceEveryFaceThatFoundThePlaceWasMet) {
  PlaceCheck check = this->check();
  for (const int face : {0, 1, 2}) check.check(met(face, 0.0));
  EXPECT_EQ(check.explain({FaultCode::kNoContact, {}}, 3).code, FaultCode::kNoContact);
}

}  // namespace
}  // namespace cell
