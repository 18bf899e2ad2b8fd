#include "sim_controller/contact.hpp"

#include <gtest/gtest.h>

#include "aimed_touch.hpp"
#include "sim_controller/admission.hpp"
#include "whole_path.hpp"

namespace sim {
namespace {

using testing::Aim;
using testing::aimed_touch;
using testing::tip_m;

/// What a microdegree on every joint may move the tip.
constexpr double kWireResolutionMetres = 1e-6;

TEST(BoxDistance, IsEuclideanOutsideAndNegativeInside) {
  const calib::Box box{"box", Eigen::Vector3d(-1, -2, -3), Eigen::Vector3d(1, 2, 3)};
  EXPECT_DOUBLE_EQ(box_distance_m(box, {2.5, 0, 0}), 1.5);
  EXPECT_DOUBLE_EQ(box_distance_m(box, {4, 6, 0}), 5.0);
  EXPECT_DOUBLE_EQ(box_distance_m(box, {-2, -4, 5}), 3.0);
  EXPECT_DOUBLE_EQ(box_distance_m(box, {0, 1.75, 0}), -0.25);
  EXPECT_DOUBLE_EQ(box_distance_m(box, {1, 0, 0}), 0.0);
}

TEST(BoxDistance, OfABallIsThatFromItsSurface) {
  const calib::Box ball{"ball", Eigen::Vector3d(1, 2, 3), Eigen::Vector3d(1, 2, 3), 0.5};
  EXPECT_DOUBLE_EQ(box_distance_m(ball, {1, 5, 7}), 4.5);
  EXPECT_DOUBLE_EQ(box_distance_m(ball, {1, 2, 2.75}), -0.25);
}

TEST(BoxDistance, InAHoleIsThatFromItsWallAndFromItsRimAbove) {
  calib::Box ring{"ring", Eigen::Vector3d(-5, -2, -5), Eigen::Vector3d(5, 2, 5)};
  ring.holes.push_back({{1, 0, 0}, {0, 1, 0}, 3.0});
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {1, 0, 0}), 3.0);
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {3, 1.5, 0}), 1.0);
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {1, -1, -3.5}), -0.5);  // in the material
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {-4, 0, 0}), -1.0);
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {-4, 5, 0}), 3.0);
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {0, 5, 0}), std::hypot(3.0, 2.0));  // from the rim
  EXPECT_DOUBLE_EQ(box_distance_m(ring, {1, 2, 1}), 2.0);
}

TEST(Contact, PutsTheTrueBallWherePlaneRadiusPretravelAndNoiseSay) {
  for (const char* name : {"edf", "demo"}) {
    const cell::Cell cell = testing::read_cell(name);
    const Plant plant = testing::true_plant(name);
    for (int face = 0; face < static_cast<int>(cell.block.faces.size()); ++face) {
      for (const double noise_m : {0.0, 37e-6, -37e-6}) {
        const auto touch = aimed_touch(cell, {.face = face, .tilt_rad = 0.7});
        const auto contact = testing::search_contact(plant, touch.motion, noise_m);
        ASSERT_TRUE(contact) << name << " face " << face;
        const auto sent = joints_from_wire(wire_from_joints(*contact));
        EXPECT_NEAR(calib::signed_distance_m(touch.contact_plane, tip_m(plant.truth, sent)), noise_m,
                    kWireResolutionMetres)
            << name << " face " << face;
      }
    }
  }
}

TEST(Contact, ComesEarlierByExactlyTheLengthThatTheTrueToolIsLonger) {
  const cell::Cell cell = testing::read_cell("demo");
  calib::ErrorVector errors = calib::ErrorVector::Zero();
  errors[*calib::error_parameter_index("r7")] = 1e-3;
  const Plant longer = make_plant(cell, errors);
  const auto touch = aimed_touch(cell, {.tilt_rad = 0.0});
  const auto contact = testing::search_contact(longer, touch.motion);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(calib::signed_distance_m(touch.contact_plane, tip_m(longer.nominal, *contact)), 1e-3, 1e-8);
}

TEST(Contact, LiesOnTheNominalArmsSearchLineWhateverTheTruthIs) {
  const cell::Cell cell = testing::read_cell("demo");
  const Plant plant = testing::true_plant("demo");
  const auto touch = aimed_touch(cell, {.face = 3, .tilt_rad = 0.7});
  const auto contact = testing::search_contact(plant, touch.motion);
  ASSERT_TRUE(contact);
  const Eigen::Vector3d start = tip_m(plant.nominal, touch.motion.approach);
  const Eigen::Vector3d way = tip_m(plant.nominal, *contact) - start;
  const Eigen::Vector3d off = way + touch.face.plane.outward * -touch.face.plane.outward.dot(way);
  EXPECT_LT(off.norm(), 1e-6);
  // The truth of the cell is millimetres away from nominal: the contact is not where the nominal ball meets
  // the face.
  EXPECT_GT(std::abs(calib::signed_distance_m(touch.contact_plane, tip_m(plant.nominal, *contact))), 1e-4);
}

TEST(Contact, OfABallBesideTheFaceIsOnTheEdge) {
  const cell::Cell cell = testing::read_cell("demo");
  const Plant plant = testing::perfect_plant("demo");
  const double beside_m = 0.002;
  const calib::Face& face = cell.block.faces[2];
  const auto touch = aimed_touch(cell, {.u_m = face.half_extent_m.x() + beside_m, .tilt_rad = 0.0});
  const auto contact = testing::search_contact(plant, touch.motion);
  ASSERT_TRUE(contact);
  const double height_m = calib::signed_distance_m(face.plane, tip_m(plant.truth, *contact));
  EXPECT_NEAR(std::hypot(height_m, beside_m), plant.trip_distance_m, 1e-7);
  EXPECT_LT(height_m, plant.trip_distance_m - 1e-4);
}

TEST(Contact, IsMissedBySearchBesideTheBlock) {
  const cell::Cell cell = testing::read_cell("demo");
  const Plant plant = testing::perfect_plant("demo");
  const auto touch =
      aimed_touch(cell, {.u_m = cell.block.faces[2].half_extent_m.x() + 0.005, .tilt_rad = 0.0});
  const auto contact = testing::search_contact(plant, touch.motion);
  EXPECT_FALSE(contact);
}

TEST(FindTrip, FindsAThinObstacleThatTheBallOnlyPasses) {
  Plant plant = testing::perfect_plant("demo");
  const Path path{plant.start_joints, plant.start_joints + calib::JointVector::Constant(0.2)};
  const Eigen::Vector3d middle = tip_m(plant.truth, posture(path, 0.5));
  plant.scene.obstacles = {
      {"wire", middle - Eigen::Vector3d::Constant(5e-4), middle + Eigen::Vector3d::Constant(5e-4)}};
  plant.trip_distance_m = 0.0;
  const auto trip = testing::find_trip(plant, path, 0.0);
  ASSERT_TRUE(trip);
  EXPECT_LE(testing::trip_gap_m(plant, posture(path, *trip), 0.0), 0.0);
  EXPECT_GT(testing::trip_gap_m(plant, posture(path, *trip - 1e-7), 0.0), 0.0);
  EXPECT_LT(*trip, 0.5);
}

}  // namespace
}  // namespace sim
