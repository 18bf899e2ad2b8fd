#include "service/acquisition/place_check.hpp"

#include <gtest/gtest.h>

#include "calib_core/geometry/face.hpp"
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

/// A block that was found by touches of one face, which say little of the others.
class FewTouchesFoundIt : public PlaceCheckTest {
 protected:
  FewTouchesFoundIt() { place_.touches.assign(1, {2, met(2, 0.0).joints, 1e-4}); }
  /// A touch of another face, so far off it.
  [[nodiscard]] static calib::Touch off_elsewhere(double off_m) {
    const Cell& cell = cell_of_owners();
    const auto plane = calib::contact_plane(cell.block.faces[0], cell.probe.stylus);
    const auto tip_m = [&](const calib::JointVector& at) -> Eigen::Vector3d {
      return calib::forward_kinematics(cell.arm.model, at).translation();
    };
    calib::JointVector joints = met(0, 0.0).joints;
    for (int step = 0; step < 5; ++step) {
      constexpr double kSmallRad = 1e-6;
      Eigen::Matrix3d slopes;
      for (int joint = 0; joint < 3; ++joint) {
        calib::JointVector turned = joints;
        turned[joint] += kSmallRad;
        slopes.col(joint) = (tip_m(turned) - tip_m(joints)) / kSmallRad;
      }
      const double missing_m = off_m - signed_distance_m(plane, tip_m(joints));
      joints.head<3>() += slopes.fullPivLu().solve(missing_m * cell.block.faces[0].plane.outward);
    }
    return {.face = 0, .joints = joints};
  }
};

TEST_F(FewTouchesFoundIt, AContactMayBeOffByWhatTheCornersOfThePlaceAreUncertain) {
  const double beside_m = cell_of_owners().nominal_position_error_m + 0.002;
  EXPECT_EQ(check().check(off_elsewhere(beside_m)).value().code, FaultCode::kBlockMoved)
      << "the place is known exactly";
  constexpr double kStdMetres = 0.023 / 3.0;
  place_.covariance.topLeftCorner<3, 3>() = kStdMetres * kStdMetres * Eigen::Matrix3d::Identity();
  EXPECT_FALSE(check().check(off_elsewhere(beside_m)));
  EXPECT_EQ(check().check(off_elsewhere(0.024)).value().code, FaultCode::kBlockMoved);
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
