#include "service/acquisition/locating.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "calib_core/geometry/rotation.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "config/truth.hpp"
#include "service/acquisition/block_pass.hpp"
#include "service/documents/block_pose_file.hpp"
#include "service/run/block_pose.hpp"
#include "service/run/touch_command.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

Cell shipped_cell(const std::string& name) {
  return read_cell(kSourceDir / "config/cells" / name / "cell.json");
}

Eigen::Isometry3d true_move() {
  return Eigen::Translation3d(0.030, 0.002, -0.025) * Eigen::AngleAxisd(0.0873, Eigen::Vector3d::UnitY());
}

/// A person who jogs the ball of an arm before a moved block onto the spots that are asked for.
class Person {
 public:
  explicit Person(const Cell& cell, const calib::ErrorVector& of_arm = calib::ErrorVector::Zero())
      : arm_(calib::apply(cell.arm.model, of_arm)), cell_(cell), spots_(place_spots(cell)) {
    calib::set_block_pose(arm_, true_move().inverse() * calib::block_pose_of(arm_));
  }

  [[nodiscard]] calib::JointVector on(const PlaceSpot& spot) const {
    const calib::Face& face = cell_.block.faces[static_cast<std::size_t>(spot.face)];
    const calib::Stylus& ball = cell_.probe.stylus;
    for (double turn = 0.0; turn < 6.3; turn += 0.3) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = spot.point_m + (ball.radius_m - ball.pretravel_m) * face.plane.outward;
      const Eigen::Vector3d inward = -face.plane.outward;
      pose.linear() = (calib::shortest_rotation(Eigen::Vector3d::UnitZ(), inward) *
                       Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
                       Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX()))
                          .toRotationMatrix();
      for (const auto& joints : calib::inverse_kinematics(arm_, cell_.arm.joint_ranges, pose)) return joints;
    }
    throw std::runtime_error("out of reach");
  }
  [[nodiscard]] HandTouch touches(std::size_t spot) const {
    const calib::JointVector joints = on(spots_[spot]);
    return {to_wire(joints), joints, 1e-4};
  }

  [[nodiscard]] const calib::KinematicModel& arm() const { return arm_; }

 private:
  calib::KinematicModel arm_;  // as it really is
  const Cell& cell_;
  std::vector<PlaceSpot> spots_;
};

class LocatingTheBlock : public ::testing::Test {
 protected:
  void take_all() {
    for (std::size_t i = 0; i < 6; ++i) locating_.take(person_.touches(i));
  }
  Cell cell_ = shipped_cell("demo");
  Person person_{cell_};
  Locating locating_{cell_};
};

TEST_F(LocatingTheBlock, AsksForThreeTouchesOnTheTopTwoOnASideAndOneOnAnEnd) {
  std::vector<int> planes;
  for (std::size_t i = 0; i < 6; ++i) {
    const HandGuide guide = locating_.guide();
    EXPECT_EQ(guide.index, static_cast<int>(i) + 1);
    EXPECT_EQ(guide.total, 6);
    EXPECT_NE(guide.words.find("plane " + std::to_string(guide.plane)), std::string::npos) << guide.words;
    planes.push_back(guide.plane);
    locating_.take(person_.touches(i));
    EXPECT_FALSE(locating_.guide().problem) << *locating_.guide().problem;
  }
  EXPECT_EQ(planes, (std::vector{3, 3, 3, 1, 1, 2}));  // plane 5 looks up too, but lies lower
}

TEST_F(LocatingTheBlock, LeavesASphereOut) {
  Cell with_ball = cell_;
  with_ball.block.faces.push_back(calib::sphere_face({0.14, -0.3, 0.11}, 0.025, {0, -1, 0}, 1.5));
  with_ball.block.face_uncertainties.emplace_back();
  const auto spots = place_spots(cell_), beside_ball = place_spots(with_ball);
  ASSERT_EQ(spots.size(), beside_ball.size());
  for (std::size_t i = 0; i < spots.size(); ++i) {
    EXPECT_EQ(spots[i].face, beside_ball[i].face);
    EXPECT_EQ(spots[i].words, beside_ball[i].words);
  }
  EXPECT_EQ(block_pose_digest(with_ball), block_pose_digest(cell_));
}

TEST_F(LocatingTheBlock, FindsItBehindTheSixthTouch) {
  take_all();
  ASSERT_TRUE(locating_.fit()) << locating_.guide().problem.value_or("");
  const Eigen::Isometry3d off = true_move().inverse() * locating_.fit()->old_from_new;
  EXPECT_LT(off.translation().norm(), 1e-6);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 1e-6);
  EXPECT_NE(locating_.guide().words.find("once more"), std::string::npos);
}

TEST_F(LocatingTheBlock, ATouchThatCameTooFastDoesNotCount) {
  HandTouch touch = person_.touches(0);
  touch.moved_m = 2 * kHandMovedMaxMetres;
  locating_.take(touch);
  EXPECT_TRUE(locating_.touches().empty());
  ASSERT_TRUE(locating_.guide().problem);
  EXPECT_NE(locating_.guide().problem->find("more slowly"), std::string::npos);
}

TEST_F(LocatingTheBlock, TheSameSpotTwiceDoesNotCount) {
  locating_.take(person_.touches(0));
  locating_.take(person_.touches(0));
  EXPECT_EQ(locating_.touches().size(), 1U);
  EXPECT_TRUE(locating_.guide().problem);
  locating_.take(person_.touches(1));
  EXPECT_FALSE(locating_.guide().problem);
}

TEST_F(LocatingTheBlock, TouchesThatFitNoBlockAreToldAndCanBeUndone) {
  for (const std::size_t spot : {0, 1, 2, 3, 5, 4}) locating_.take(person_.touches(spot));
  EXPECT_FALSE(locating_.fit());
  ASSERT_TRUE(locating_.guide().problem);
  locating_.undo();
  locating_.undo();
  EXPECT_EQ(locating_.guide().index, 5);
  locating_.take(person_.touches(4));
  locating_.take(person_.touches(5));
  EXPECT_TRUE(locating_.fit());
}

TEST_F(LocatingTheBlock, ATouchTakenByWordSaysLess) {
  take_all();
  const double sure_m = std::sqrt(locating_.fit()->covariance(0, 0));
  Locating by_word(cell_);
  for (std::size_t i = 0; i < 6; ++i) {
    HandTouch touch = person_.touches(i);
    touch.moved_m.reset();
    by_word.take(touch);
  }
  EXPECT_GT(std::sqrt(by_word.fit()->covariance(0, 0)), sure_m);
}

TEST_F(LocatingTheBlock, ThePassLeavesItsDistanceOverEveryFace) {
  take_all();
  const Cell there = cell_with_block_pose(cell_, {.cell_from_block = locating_.fit()->old_from_new,
                                                  .covariance = locating_.fit()->covariance,
                                                  .std_block_pose = locating_.fit()->std_block_pose});
  EXPECT_GT(there.face_error_m(), cell_.nominal_position_error_m);
  const auto postures = pass_postures(there, locating_.touches());
  ASSERT_TRUE(std::holds_alternative<std::vector<calib::JointVector>>(postures))
      << std::get<std::string>(postures);
  std::set<int> met;
  for (const calib::JointVector& joints : std::get<std::vector<calib::JointVector>>(postures)) {
    const Eigen::Vector3d ball_m = calib::forward_kinematics(there.arm.model, joints).translation();
    for (std::size_t face = 0; face < 4; ++face) {
      const double off_m =
          calib::signed_distance_m(there.block.faces[face].plane, ball_m) - there.probe.stylus.radius_m;
      if (std::abs(off_m - kPassMetres) < 1e-6) met.insert(static_cast<int>(face));
    }
  }
  EXPECT_EQ(met, (std::set<int>{0, 1, 2}));
}

/// The farthest that a touch of a face, planned for the cell's arm with its block at the found place, is from
/// where this arm makes it.
double worst_miss_m(const Cell& there, const calib::KinematicModel& of_person) {
  double worst_m = 0.0;
  for (const PlaceSpot& spot : place_spots(there)) {
    const calib::Face& face = there.block.faces[static_cast<std::size_t>(spot.face)];
    for (double turn = 0.0; turn < 6.3; turn += 0.3) {
      Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
      pose.translation() = face.center_m + there.probe.stylus.radius_m * face.plane.outward;
      pose.linear() =
          (calib::shortest_rotation(Eigen::Vector3d::UnitZ(), Eigen::Vector3d(-face.plane.outward)) *
           Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
              .toRotationMatrix();
      for (const auto& joints : calib::inverse_kinematics(there.arm.model, there.arm.joint_ranges, pose))
        worst_m = std::max(
            worst_m,
            (calib::forward_kinematics(of_person, joints).translation() - pose.translation()).norm());
    }
  }
  return worst_m;
}

TEST(LocatedFaces, AreWithinTheClearancesOfAnArmAsFarOffAsTheShippedOnes) {
  for (const std::string name : {"demo", "edf"}) {
    const Cell cell = shipped_cell(name);
    const Person person(cell, read_truth(kSourceDir / "config/cells" / name / "truth.json").errors);
    Locating locating(cell);
    for (std::size_t i = 0; i < 6; ++i) locating.take(person.touches(i));
    ASSERT_TRUE(locating.fit()) << name << locating.guide().problem.value_or("");
    const Cell there = cell_with_block_pose(
        cell, {.cell_from_block = locating.fit()->old_from_new, .covariance = locating.fit()->covariance});
    const double miss_m = worst_miss_m(there, person.arm());
    EXPECT_GT(miss_m, 0.2 * there.face_error_m()) << name << ": else this shows nothing";
    EXPECT_LT(miss_m, there.face_error_m()) << name;
  }
}

TEST_F(LocatingTheBlock, APlaceIsReadBackAsItWasWritten) {
  take_all();
  const Folder folder;
  const std::filesystem::path file = folder.path() / "place.json";
  EXPECT_FALSE(read_block_pose(file));
  const BlockPose place{.cell_from_block = locating_.fit()->old_from_new,
                        .covariance = locating_.fit()->covariance,
                        .std_block_pose = locating_.fit()->std_block_pose,
                        .touches = locating_.touches(),
                        .located_at = "2026-11-22T03:00:00.000Z",
                        .digest = block_pose_digest(cell_)};
  write_block_pose(file, place);
  write_block_pose(file, place);
  const auto read = read_block_pose(file);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->cell_from_block.isApprox(place.cell_from_block, 1e-12));
  EXPECT_TRUE(read->covariance.isApprox(place.covariance, 1e-12));
  EXPECT_EQ(read->std_block_pose, place.std_block_pose);
  ASSERT_EQ(read->touches.size(), 6U);
  EXPECT_TRUE(read->touches[5].joints.isApprox(place.touches[5].joints, 1e-12));
  EXPECT_EQ(read->digest, place.digest);
  EXPECT_NE(block_pose_digest(shipped_cell("edf")), place.digest);
}

TEST_F(LocatingTheBlock, APlaceThatWasChangedByOtherMeansIsRefused) {
  take_all();
  const Folder folder;
  const std::filesystem::path file = folder.path() / "place.json";
  write_block_pose(file, {.cell_from_block = locating_.fit()->old_from_new,
                          .covariance = locating_.fit()->covariance,
                          .std_block_pose = {},
                          .touches = locating_.touches(),
                          .located_at = "2026-11-22T03:00:00.000Z",
                          .digest = block_pose_digest(cell_)});
  nlohmann::json changed;
  std::ifstream(file) >> changed;
  changed["shift_mm"][2] = changed["shift_mm"][2].get<double>() + 250.0;
  std::ofstream(file) << changed;
  EXPECT_THROW(static_cast<void>(read_block_pose(file)), ConfigError);
}

cs8::State state_at(const calib::JointVector& joints, bool touched) {
  return {.flags = cs8::kSettled | cs8::kArmCalibrated |
                   (touched ? std::uint32_t{cs8::kProbeTouched} : std::uint32_t{cs8::kProbeLoopClosed}),
          .joints = to_wire(joints)};
}

TEST_F(LocatingTheBlock, ATouchIsWhereTheProbeReadsTouchedFirst) {
  HandTouchWatch watch(cell_.arm.model);
  const calib::JointVector on = person_.on(place_spots(cell_)[0]);
  calib::JointVector before = on;
  before[1] += 1e-4;
  EXPECT_FALSE(watch.on_controller_state(state_at(on, true)));  // nobody saw it free
  EXPECT_FALSE(watch.on_controller_state(state_at(before, false)));
  cs8::State between = state_at(before, false);
  between.flags = cs8::kSettled | cs8::kArmCalibrated;  // its two inputs change one after the other
  EXPECT_FALSE(watch.on_controller_state(between));
  const auto touch = watch.on_controller_state(state_at(on, true));
  ASSERT_TRUE(touch);
  EXPECT_EQ(touch->wire_joints, to_wire(on));
  EXPECT_GT(*touch->moved_m, 0.0);
  EXPECT_LT(*touch->moved_m, 2e-4);
  EXPECT_FALSE(watch.on_controller_state(state_at(on, true)));  // once
}

TEST_F(LocatingTheBlock, NothingIsTakenByWordFromAFreeProbeOrAMovingArm) {
  HandTouchWatch watch(cell_.arm.model);
  EXPECT_TRUE(std::holds_alternative<std::string>(watch.take()));
  const calib::JointVector on = person_.on(place_spots(cell_)[0]);
  watch.on_controller_state(state_at(on, false));
  EXPECT_TRUE(std::holds_alternative<std::string>(watch.take()));
  cs8::State moving = state_at(on, true);
  moving.flags &= ~std::uint32_t{cs8::kSettled};
  watch.on_controller_state(moving);
  EXPECT_TRUE(std::holds_alternative<std::string>(watch.take()));
  watch.on_controller_state(state_at(on, true));
  EXPECT_TRUE(std::holds_alternative<std::string>(watch.take())) << "it was given out when the probe tripped";
}

TEST_F(LocatingTheBlock, AContactIsOneTouchHoweverOftenItIsAskedFor) {
  HandTouchWatch watch(cell_.arm.model);
  const calib::JointVector on = person_.on(place_spots(cell_)[0]);
  watch.on_controller_state(state_at(on, true));  // it touched before anybody looked
  EXPECT_TRUE(std::holds_alternative<HandTouch>(watch.take()));
  EXPECT_TRUE(std::holds_alternative<std::string>(watch.take()));
  watch.on_controller_state(state_at(on, false));
  EXPECT_TRUE(watch.on_controller_state(state_at(on, true)));
  EXPECT_TRUE(std::holds_alternative<std::string>(watch.take()));
}

TEST_F(LocatingTheBlock, NothingIsTakenFromAProbeInFaultOrAnArmWithoutReferences) {
  const calib::JointVector on = person_.on(place_spots(cell_)[0]);
  for (const std::uint32_t lost : {std::uint32_t{cs8::kProbeTouched}, std::uint32_t{cs8::kArmCalibrated}}) {
    HandTouchWatch watch(cell_.arm.model);
    watch.on_controller_state(state_at(on, false));
    cs8::State state = state_at(on, true);
    state.flags &= ~lost;
    EXPECT_FALSE(watch.on_controller_state(state)) << lost;
    EXPECT_TRUE(std::holds_alternative<std::string>(watch.take())) << lost;
  }
}

TEST_F(LocatingTheBlock, AContactThatBouncesIsNotTakenForTheNextFace) {
  const auto spots = place_spots(cell_);
  for (int i = 0; i < 3; ++i) locating_.take({{}, person_.on(spots[static_cast<std::size_t>(i)]), 0.0});
  ASSERT_NE(spots[2].face, spots[3].face);
  locating_.take({{}, person_.on(spots[2]), 0.0});
  EXPECT_EQ(locating_.touches().size(), 3U);
  EXPECT_TRUE(locating_.guide().problem);
}

}  // namespace
}  // namespace cell
