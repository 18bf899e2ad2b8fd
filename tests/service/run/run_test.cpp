#include "service/run/run.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>

#include "config/identification_problem.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

StoredTouch stored_touch(int number, const calib::Touch& touch) {
  return {.number = number, .plane = touch.face + 1, .role = touch.role, .joints = to_wire(touch.joints)};
}

class RunTest : public ::testing::Test {
 protected:
  RunTest() {
    calib::TouchPlan plan;
    for (const calib::Touch& touch : table3_touches()) {
      const calib::JointVector& joints = touch.joints;
      plan.touches.push_back(
          {touch.face, touch.role, joints, joints, joints, joints, Eigen::Vector3d::UnitX()});
    }
    run_.set_plan(plan);
  }

  /// As a touch is kept: stored, then added to the run.
  void keep(cell::Run& run, const StoredTouch& touch) {
    store_.append_touch(run.id(), touch);
    run.add(touch);
  }

  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
  TipRegions regions_{edf()};
  cell::Run run_{store_.begin_run({.recipe = "edf-25"}), regions_, edf().recipes.at("edf-25"), "start"};
};

TEST_F(RunTest, GoesThroughItsPlanTouchByTouchAndEndsWithTheResult) {
  int number = 0;
  for (const calib::Touch& touch : table3_touches()) {
    EXPECT_FALSE(run_.complete());
    ASSERT_NE(run_.next(), nullptr);
    EXPECT_EQ(run_.next()->face, touch.face);
    keep(run_, stored_touch(++number, touch));
    EXPECT_EQ(run_.touches_done(), number);
    EXPECT_EQ(run_.latest().fitted_touch_count, number - 1) << "not yet";
    run_.identify();
    EXPECT_EQ(run_.latest().fitted_touch_count, number);
    EXPECT_EQ(run_.predicted_tip_rms_m().has_value(), run_.latest().uncertainty.has_value()) << number;
  }
  EXPECT_TRUE(run_.complete());
  EXPECT_EQ(run_.next(), nullptr);
  EXPECT_EQ(run_.latest().status, calib::IdentificationStatus::kConverged);
  EXPECT_EQ(run_.latest().fitted_touch_count, number);
  EXPECT_GT(run_.predicted_tip_rms_m().value_or(0.0), 0.0);
  EXPECT_EQ(store_.touches(run_.id()).size(), table3_touches().size());
}

TEST_F(RunTest, WhatIsLeftTakesAsMuchLongerThanPlannedAsWhatIsMadeTook) {
  calib::TouchPlan plan{.touches = std::vector<calib::PlannedTouch>(3), .park_s = 5.0};
  for (std::size_t i = 0; i < 3; ++i) {
    plan.touches[i].travel_s = 2.0;
    plan.touches[i].touch_s = std::array{6.0, 4.0, 20.0}[i];
  }
  run_.set_plan(plan);
  EXPECT_EQ(run_.remaining_s(0.0), plan.duration_s());
  keep(run_, stored_touch(1, table3_touches()[0]));
  keep(run_, stored_touch(2, table3_touches()[1]));
  EXPECT_DOUBLE_EQ(run_.remaining_s(7.0), (2.0 + 20.0 + 5.0) * 7.0 / (2.0 + 6.0 + 2.0 + 4.0));
}

TEST_F(RunTest, ATouchThatIsNotStoredDoesNotCount) {
  keep(run_, stored_touch(1, table3_touches()[0]));
  EXPECT_THROW(keep(run_, stored_touch(1, table3_touches()[1])), std::exception);
  EXPECT_EQ(run_.touches_done(), 1);
  run_.identify();
  EXPECT_EQ(run_.latest().fitted_touch_count, 1);
  EXPECT_EQ(store_.touches(run_.id()).size(), 1u);
}

TEST_F(RunTest, AResultFromACopyCountsWhileTheTouchesAreThoseItIsOf) {
  keep(run_, stored_touch(1, table3_touches()[0]));
  EXPECT_TRUE(run_.identification_is_due());
  cell::Run copy = run_.copy_to_identify();
  EXPECT_FALSE(run_.identification_is_due()) << "once, also where it fails";
  EXPECT_FALSE(run_.take_latest(copy)) << "nothing was computed";
  copy.identify();
  EXPECT_TRUE(run_.take_latest(copy));
  EXPECT_EQ(run_.latest().fitted_touch_count, 1);
  EXPECT_FALSE(run_.identify());
  cell::Run other(store_.begin_run({.recipe = "edf-25"}), regions_, edf().recipes.at("edf-25"), "start");
  keep(other, stored_touch(1, table3_touches()[0]));
  EXPECT_FALSE(other.take_latest(copy)) << "of another run";
  keep(run_, stored_touch(2, table3_touches()[1]));
  EXPECT_FALSE(run_.take_latest(copy)) << "a touch came meanwhile";
  EXPECT_TRUE(run_.identification_is_due());
}

TEST_F(RunTest, ATouchThatIsPutOffComesBehindTheOthersOfItsRoleOnce) {
  const std::size_t count = static_cast<std::size_t>(run_.touches_total());
  const calib::JointVector put_off = run_.planned(3)->joints;
  const calib::JointVector behind = run_.planned(4)->joints;
  EXPECT_TRUE(run_.defer(3));
  EXPECT_EQ(run_.planned(3)->joints, behind);
  EXPECT_EQ(run_.planned(count - 1)->joints, put_off);
  EXPECT_FALSE(run_.defer(count - 1)) << "it is the last";
  EXPECT_TRUE(run_.defer(count - 2));
  EXPECT_FALSE(run_.defer(count - 2)) << "it was put off before";
  EXPECT_EQ(run_.planned(count), nullptr);
}

TEST_F(RunTest, TellsWhatMoreTouchesWouldBringOnceAllIsSeen) {
  int number = 0;
  for (const calib::Touch& touch : table3_touches()) {
    keep(run_, stored_touch(++number, touch));
    if (number == 30) {
      run_.identify();
      EXPECT_FALSE(run_.touch_benefit());
    }
  }
  run_.identify();
  EXPECT_THAT(run_.touch_benefit().value_or(""),
              ::testing::MatchesRegex("8 more on plane [1-4]: .* to .* mm"));
}

TEST_F(RunTest, ARunIsGoodEnoughWhenItsRecipeAsksForAnAccuracyAndHasIt) {
  Recipe asking = edf().recipes.at("edf-25");
  int number = 0;
  for (const calib::Touch& touch : table3_touches()) keep(run_, stored_touch(++number, touch));
  run_.identify();
  const double reached_m = run_.predicted_tip_rms_m().value();
  EXPECT_FALSE(run_.meets_accuracy_goal()) << "nothing was asked for";
  for (const double share : {0.9, 1.1}) {
    asking.goal.tip_rms_max_m = share * reached_m;
    cell::Run run(store_.begin_run({.recipe = "edf-25"}), regions_, asking, "start");
    EXPECT_FALSE(run.meets_accuracy_goal());
    number = 0;
    for (const calib::Touch& touch : table3_touches()) keep(run, stored_touch(++number, touch));
    run.identify();
    EXPECT_EQ(run.meets_accuracy_goal(), share > 1.0);
  }
}

/// Five touches of the reference place, which moves evenly by so much along its face's normal, made by the
/// nominal arm.
std::vector<cell::ReferenceTouch> references_moved_by(double drift_m, const cell::Run& run,
                                                      const calib::IdentificationProblem& problem) {
  constexpr int kReadings = 5;
  const calib::Touch place = cell::to_touch(run.touches().front());
  const calib::ContactSurface& plane =
      problem.artefact.contact_planes.at(static_cast<std::size_t>(place.face));
  const auto height_m = [&](const calib::JointVector& joints) {
    return signed_distance_m(plane, forward_chain(prepare(problem.nominal), joints).tip_in_block_m());
  };
  constexpr double kProbeRad = 1e-4;
  const calib::JointVector unit = calib::JointVector::Unit(1);
  const double m_per_rad = (height_m(place.joints + kProbeRad * unit) - height_m(place.joints)) / kProbeRad;
  std::vector<cell::ReferenceTouch> made;
  for (int i = 0; i < kReadings; ++i) {
    const double angle_rad = drift_m * i / (kReadings - 1) / m_per_rad;
    made.push_back({.number = i + 1, .joints = cell::to_wire(place.joints + angle_rad * unit)});
  }
  return made;
}

TEST_F(RunTest, TheDriftOfTheReferencePlaceIsInTheTipsUncertainty) {
  int number = 0;
  for (const calib::Touch& touch : table3_touches()) keep(run_, stored_touch(++number, touch));
  run_.note_references(references_moved_by(0.0, run_, run_.problem()));
  run_.identify();
  EXPECT_EQ(run_.problem().drift_m, 0.0);
  constexpr double kDriftM = 1e-4;
  run_.note_references(references_moved_by(kDriftM, run_, run_.problem()));
  EXPECT_NEAR(run_.problem().drift_m, kDriftM, 1e-6);
  EXPECT_TRUE(run_.identify()) << "no touch more, but a drift";
  EXPECT_FALSE(run_.identify());
  const calib::UncertaintySource& drift = run_.latest().uncertainty->sources.back();
  EXPECT_EQ(drift.name, "drift");
  // Half of it, in each of three directions, and of what the steps of the wire leave open.
  const double open_m = run_.problem().drift_uncertainty.std_m;
  EXPECT_LT(open_m, 2e-7);
  EXPECT_NEAR(drift.covariance.trace(),
              3.0 * (std::pow(run_.problem().drift_m / 2.0, 2) + std::pow(open_m / 2.0, 2)), 1e-15);
}

TEST_F(RunTest, WhatTheReferencePlaceScattersIsPureError) {
  int number = 0;
  for (const calib::Touch& touch : table3_touches()) keep(run_, stored_touch(++number, touch));
  EXPECT_FALSE(run_.problem().pure_error);
  run_.note_references(references_moved_by(1e-4, run_, run_.problem()));
  ASSERT_TRUE(run_.problem().pure_error);
  EXPECT_EQ(run_.problem().pure_error->degrees_of_freedom, 3.0) << "five about a line";
  EXPECT_LT(run_.problem().pure_error->std_m, 1e-7) << "they are on the line";
  run_.identify();
  EXPECT_TRUE(run_.latest().lack_of_fit->is_f_test());
}

TEST_F(RunTest, TouchesLeftOutAreThoseToFitFromThereOn) {
  const int before = run_.touches_total();
  EXPECT_EQ(run_.drop_fit_touches(static_cast<std::size_t>(before)), 0);
  calib::TouchPlan plan;
  for (const calib::TouchRole role :
       {calib::TouchRole::kFit, calib::TouchRole::kFit, calib::TouchRole::kFit, calib::TouchRole::kHeldOut}) {
    plan.touches.emplace_back();
    plan.touches.back().role = role;
  }
  run_.set_plan(plan);
  EXPECT_EQ(run_.drop_fit_touches(1), 2);
  EXPECT_EQ(run_.touches_total(), 2);
  EXPECT_EQ(run_.planned(1)->role, calib::TouchRole::kHeldOut);
}

TEST_F(RunTest, WithoutAPlanNothingIsCompleteAndNothingIsNext) {
  const cell::Run planless(1, regions_, edf().recipes.at("edf-25"), "start");
  EXPECT_FALSE(planless.complete());
  EXPECT_EQ(planless.next(), nullptr);
}

TEST(ToTouch, TurnsTheWiresUnitsIntoRadiansAndThePlaneIntoAFace) {
  const calib::Touch touch = to_touch(
      {.plane = 3, .role = calib::TouchRole::kHeldOut, .joints = {180'000'000, -90'000'000, 1, 0, 0, 0}});
  EXPECT_EQ(touch.face, 2);
  EXPECT_EQ(touch.role, calib::TouchRole::kHeldOut);
  EXPECT_DOUBLE_EQ(touch.joints[0], std::numbers::pi);
  EXPECT_DOUBLE_EQ(touch.joints[1], -std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(touch.joints[2], std::numbers::pi / 180e6);
}

TEST(ContactPlanes, LieABallsRadiusLessThePretravelOffTheFaces) {
  Cell cell = edf();
  cell.probe.stylus = {.radius_m = 0.003, .pretravel_m = 1e-5};
  const auto planes = identification_problem(cell, cell.recipes.at("edf-25")).artefact.contact_planes;
  ASSERT_EQ(planes.size(), cell.block.faces.size());
  for (std::size_t i = 0; i < planes.size(); ++i) {
    EXPECT_EQ(planes[i].outward, cell.block.faces[i].plane.outward);
    EXPECT_DOUBLE_EQ(planes[i].offset_m, cell.block.faces[i].plane.offset_m + 0.003 - 1e-5);
  }
}

}  // namespace
}  // namespace cell
