// Runs that touch the block at two places: a person brings it from one to the other between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/numerics/halton.hpp"
#include "config/truth.hpp"
#include "service/acquisition/block_move.hpp"
#include "service/run/run.hpp"
#include "service/run/touch_command.hpp"
#include "tests/config/cell_with_places.hpp"
#include "tests/end_to_end/held_out.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::kTwoPlaces;
using cell::State;
using ::testing::HasSubstr;

constexpr const char* kStand = "stand";
constexpr int kAtEachFace = cell::kFitAtEach + cell::kHeldOutAtEach;
/// The plate stays where it is.
constexpr int kFacesOfCube = 4;
constexpr int kFacesAtFirst = kFacesOfCube + 1;
constexpr int kTouchesAtFirst = kFacesAtFirst * kAtEachFace;
constexpr int kTouchesAtBoth = kTouchesAtFirst + kFacesOfCube * kAtEachFace;

/// Metres and radians, of a place that is found by as few touches as these.
constexpr double kFoundStdMax = 0.2e-3;
/// A step of the encoders.
constexpr double kStandsStillRad = 1e-6;

class Places : public ::testing::Test {
 protected:
  explicit Places(const nlohmann::json& stand = cell::known_stand()) : loop_("demo") {
    loop_.use(cell::read_cell(cell::write_demo_at_two_places(stand, files_)), kCandidateCount);
    loop_.cell.recipes.at(kTwoPlaces).candidate_count = kCandidateCount;
  }

  /// Serves the cell whose stand is off by this, and makes it ready.
  void launch(const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn_rad) {
    const cell::Truth truth{.errors = errors_,
                            .places = {{.name = kStand, .shift_m = shift_m, .turn_rad = turn_rad}}};
    const sim::PlantByPlace plants = sim::make_plants(loop_.cell, truth);
    loop_.serve(plants.at(cell::kFirstPlace), {.controller = {.speed = sim::kSpeedMax}, .plants = plants});
    loop_.launch();
    loop_.run_until(State::kIdle);
  }
  void launch_with_dowels() { launch({4e-6, -3e-6, 2e-6}, {1e-5, -1.5e-5, 1e-5}); }

  [[nodiscard]] calib::JointVector joints() const {
    return cell::from_wire(const_cast<LoopbackCell&>(loop_).server().report().joints);
  }
  [[nodiscard]] bool stands_at(const calib::JointVector& there) const {
    return (joints() - there).cwiseAbs().maxCoeff() < kStandsStillRad;
  }
  void bring(const std::string& place) { EXPECT_EQ(loop_.server().bring_block(place).value_or(""), ""); }
  void resume() {
    loop_.command(Command::kResume);
    loop_.run_until_over();
  }
  void expect_hold_for(const std::string& place) {
    ASSERT_EQ(loop_.status().state, State::kHeld)
        << (loop_.status().fault ? loop_.status().fault->message() : "without a fault");
    EXPECT_EQ(loop_.fault_name(), "block_to_move");
    EXPECT_THAT(loop_.status().fault->message(), HasSubstr("\"" + place + "\""));
    EXPECT_EQ(loop_.status().block_place, place);
  }
  /// A run that has touched everything at the first place and asks for the stand.
  std::int64_t run_to_hold() {
    const std::int64_t run = loop_.start(kTwoPlaces);
    loop_.run_until_over();
    expect_hold_for(kStand);
    EXPECT_EQ(loop_.status().touches_done, kTouchesAtFirst);
    EXPECT_TRUE(stands_at(loop_.cell.park_joints)) << "parked";
    return run;
  }
  /// The block stays on the stand, whose run is over.
  void stop_with_block_on_stand() {
    launch_with_dowels();
    run_to_hold();
    bring(kStand);
    loop_.command(Command::kStop);
    loop_.run_until(State::kStopped);
    loop_.command(Command::kReset);
    loop_.run_until(State::kIdle);
  }
  [[nodiscard]] std::ptrdiff_t touches_on_stand(std::int64_t run) {
    return std::ranges::count_if(loop_.store().touches(run),
                                 [](const cell::StoredTouch& touch) { return touch.plane > kFacesAtFirst; });
  }
  void expect_complete(std::int64_t run) {
    ASSERT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
    EXPECT_EQ(loop_.fault_name(), "");
    EXPECT_EQ(loop_.status().verdict, cell::Verdict::kAccepted);
    EXPECT_EQ(loop_.store().touches(run).size(), static_cast<std::size_t>(kTouchesAtBoth));
    EXPECT_EQ(touches_on_stand(run), kFacesOfCube * kAtEachFace);
    for (const cell::StoredTouch& touch : loop_.store().touches(run)) EXPECT_LE(touch.plane, 9);
  }
  /// As good as of the other arms in other_arm_test.
  void expect_true_arm() {
    const calib::IdentificationResult& result = loop_.operation().run()->latest();
    EXPECT_TRUE(result.rejected.empty());
    EXPECT_LE(held_out(result).mean_max_m, loop_.cell.acceptance.held_out_mean_max_m);
    EXPECT_LE(held_out(result).rms_m, loop_.cell.acceptance.held_out_rms_max_m);
    const calib::KinematicModel truth = calib::apply(loop_.cell.arm.model, errors_);
    const double achieved_m = tip_rms_m(result.calibrated, truth);
    EXPECT_LE(achieved_m, 0.25e-3);
    EXPECT_LE(10.0 * achieved_m, tip_rms_m(loop_.cell.arm.model, truth));
  }
  /// What was found of the stand is what the simulator hides, within four standard deviations.
  void expect_true_stand(const Eigen::Vector3d& shift_m, const Eigen::Vector3d& turn_rad) {
    const auto& parameters = loop_.operation().run()->problem().artefact.parameters;
    const calib::IdentificationResult& result = loop_.operation().run()->latest();
    int seen = 0;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      if (!calib::is_of_place(parameters[k])) continue;
      const Eigen::Vector3d& hidden =
          parameters[k].kind == calib::ArtefactKind::kPlaceTurn ? turn_rad : shift_m;
      const double std = result.uncertainty->artefact_std[static_cast<Eigen::Index>(k)];
      EXPECT_NEAR(result.artefact_errors[static_cast<Eigen::Index>(k)], hidden[seen % 3], 4.0 * std)
          << parameters[k].name;
      EXPECT_LE(std, kFoundStdMax) << parameters[k].name;
      ++seen;
    }
    EXPECT_EQ(seen, 6);
  }

  static constexpr int kCandidateCount = 3'000;
  const cell::Folder files_;
  const calib::ErrorVector errors_ = shipped_truth("demo");
  LoopbackCell loop_;

 private:
  [[nodiscard]] double tip_rms_m(const calib::KinematicModel& a, const calib::KinematicModel& b) const {
    constexpr int kPostureCount = 200;
    double sum = 0.0;
    for (int i = 1; i <= kPostureCount; ++i) {
      const calib::JointVector at = calib::halton_posture(i, loop_.cell.arm.joint_ranges);
      sum += (calib::forward_kinematics(a, at).translation() - calib::forward_kinematics(b, at).translation())
                 .squaredNorm();
    }
    return std::sqrt(sum / kPostureCount);
  }
};

TEST_F(Places, AKnownStepIsTouchedAtBothEndsWithAPersonInBetween) {
  const Eigen::Vector3d shift_m(4e-6, -3e-6, 2e-6), turn_rad(1e-5, -1.5e-5, 1e-5);
  launch(shift_m, turn_rad);
  const std::int64_t run = run_to_hold();
  EXPECT_EQ(touches_on_stand(run), 0);
  bring(kStand);
  resume();
  expect_complete(run);
  EXPECT_EQ(loop_.status().last_accepted_run_id, run);
  expect_true_arm();
  expect_true_stand(shift_m, turn_rad);
}

class EstimatedPlace : public Places {
 protected:
  EstimatedPlace() : Places(cell::estimated_stand(3.0)) {}
};

TEST_F(EstimatedPlace, IsFoundAMillimetreAndThreeMilliradiansOff) {
  const Eigen::Vector3d shift_m(0.6e-3, -0.6e-3, 0.5e-3), turn_rad(2e-3, -1.5e-3, 1.6e-3);
  launch(shift_m, turn_rad);
  const std::int64_t run = run_to_hold();
  EXPECT_EQ(loop_.operation().run()->latest().status, calib::IdentificationStatus::kConverged)
      << "the touches of the first place have a result before the other one is known";
  bring(kStand);
  resume();
  expect_complete(run);
  expect_true_arm();
  expect_true_stand(shift_m, turn_rad);
}

TEST_F(Places, ARunThatIsStoppedInTheHoldLeavesTheBlockToBeBroughtBackBeforeTheNextMoves) {
  stop_with_block_on_stand();
  const calib::JointVector before = joints();
  const std::int64_t next = loop_.start(kFewCandidates);
  loop_.run_until_over();
  expect_hold_for(cell::kFirstPlace);
  EXPECT_TRUE(stands_at(before));
  EXPECT_TRUE(loop_.store().touches(next).empty());
  bring(cell::kFirstPlace);
  resume();
  ASSERT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.status().verdict, cell::Verdict::kAccepted);
  const std::int64_t third = loop_.start(kFewCandidates);  // the block is back: nobody is asked again
  loop_.run_until([](const cell::Status& status) { return status.touches_done >= 1 || status.fault; });
  EXPECT_EQ(loop_.fault_name(), "");
  EXPECT_FALSE(loop_.store().touches(third).empty());
}

TEST_F(Places, ARunThatWasBegunWithTheBlockAwayAsksForItAlsoFromTheNextDaemon) {
  stop_with_block_on_stand();
  const calib::JointVector before = joints();
  const std::int64_t next = loop_.start(kFewCandidates);
  loop_.relaunch();  // it is not planned yet
  ASSERT_EQ(loop_.status().state, State::kHeld);
  EXPECT_FALSE(loop_.store().plan_json(next)) << "else this shows nothing";
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  resume();
  expect_hold_for(cell::kFirstPlace);
  EXPECT_TRUE(stands_at(before));
}

TEST_F(Places, ADaemonThatEndsInTheHoldHasTheNextOneAskAgainBeforeAnythingMoves) {
  launch_with_dowels();
  const std::int64_t run = run_to_hold();
  loop_.relaunch();
  ASSERT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.fault_name(), "daemon_restarted");
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  const calib::JointVector before = joints();
  resume();
  expect_hold_for(kStand);
  EXPECT_TRUE(stands_at(before));
  EXPECT_EQ(loop_.status().touches_done, kTouchesAtFirst);
  bring(kStand);
  resume();
  expect_complete(run);
  expect_true_arm();
}

TEST_F(Places, ADaemonThatEndsOnTheWayAtTheStandGoesOnThere) {
  launch_with_dowels();
  const std::int64_t run = run_to_hold();
  bring(kStand);
  loop_.command(Command::kResume);
  loop_.run_until_touches(kTouchesAtFirst + 12);
  loop_.relaunch();
  ASSERT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.status().block_place, kStand) << "told before its plan is read";
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  resume();
  expect_complete(run);
  expect_true_arm();
}

TEST_F(Places, APersonWhoResumesWithoutTheBlockHasNoTouchKept) {
  launch_with_dowels();
  const std::int64_t run = run_to_hold();
  resume();
  ASSERT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.fault_name(), "no_contact") << loop_.status().fault->message();
  EXPECT_EQ(touches_on_stand(run), 0);
  bring(kStand);
  loop_.command(Command::kRetry);
  loop_.run_until_over();
  expect_complete(run);
  expect_true_arm();
}

/// 50 mm beside where the cube was located.
class BesidePlace : public Places {
 protected:
  BesidePlace() : Places(beside()) {}

 private:
  static nlohmann::json beside() {
    nlohmann::json stand = cell::known_stand();
    stand["position_mm"] = {0, 0, -200};
    return stand;
  }
};

TEST_F(BesidePlace, APersonWhoForgetsTheBlockHasNothingDrivenIntoIt) {
  launch_with_dowels();
  const std::int64_t run = run_to_hold();
  resume();
  ASSERT_EQ(loop_.status().state, State::kHeld) << loop_.fault_name();
  EXPECT_EQ(loop_.fault_name(), "no_contact") << loop_.status().fault->message();
  EXPECT_EQ(touches_on_stand(run), 0);
  bring(kStand);
  loop_.command(Command::kRetry);
  loop_.run_until_over();
  expect_complete(run);
}

}  // namespace
}  // namespace touchcal::testing
