// A run with a star stylus: each of its tips touches the block, and the touches find where its balls are.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "calib_core/kinematics/error_parameters.hpp"
#include "config/touched_places.hpp"
#include "config/true_tips.hpp"
#include "config/truth.hpp"
#include "service/run/run.hpp"
#include "service/run/touch_command.hpp"
#include "tests/end_to_end/held_out.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::State;

constexpr const char* kStar = "star";
constexpr int kStarCandidates = 4'000;
constexpr std::size_t kShownByAStar = 27;
/// Where the balls of a star are when they touch is known no worse than this by some 30 touches, and where
/// they are in R_7, which the direction of the last axis takes part in; metres.
constexpr double kBallOffMax = 0.15e-3, kBallStdMax = 0.25e-3;

class StarRun : public ::testing::Test {
 protected:
  StarRun() {
    loop_.use(shipped_cell(kStar), kStarCandidates);
    loop_.cell.recipes.at(kStar).candidate_count = kStarCandidates;
    truth_ = cell::read_truth(loop_.cell.file.parent_path() / "truth.json");
    const sim::PlantByPlace plants = sim::make_plants(loop_.cell, truth_);
    loop_.serve(plants.at(cell::kFirstPlace), {.controller = {.speed = sim::kSpeedMax}, .plants = plants});
    loop_.launch();
    loop_.run_until(State::kIdle);
  }

  [[nodiscard]] const cell::Recipe& recipe() const { return loop_.cell.recipes.at(kStar); }

  [[nodiscard]] const cell::ProbeTip& drawn_tip(int tip) const {
    const int index = recipe().tips[static_cast<std::size_t>(tip) - 1];
    return loop_.cell.probe.tips[static_cast<std::size_t>(index)];
  }
  /// The true centre of a tip's ball against where the file has it, in R_7 of the true arm.
  [[nodiscard]] Eigen::Vector3d shift_m(const std::string& tip) const {
    const auto found = std::ranges::find(truth_.tips, tip, &cell::TrueTip::name);
    return found->shift_m;
  }

  cell::Truth truth_;
  LoopbackCell loop_;
};

/// Where a ball is on the identified arm, against where it is on the true one: both in R_-1, so that it does
/// not matter which parameters took up the difference.
TEST_F(StarRun, FindsTheBallsAndTwoMoreParametersOfTheArm) {
  const std::int64_t run = loop_.start(kStar);
  loop_.run_until_over();
  ASSERT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.status().verdict, cell::Verdict::kAccepted);
  const calib::IdentificationProblem& problem = loop_.operation().run()->problem();
  const calib::IdentificationResult& result = loop_.operation().run()->latest();
  EXPECT_EQ(result.identifiable.columns.size(), kShownByAStar);
  EXPECT_TRUE(result.rejected.empty());
  EXPECT_LE(held_out(result).rms_m, loop_.cell.acceptance.held_out_rms_max_m);

  std::set<int> tips;
  for (const cell::StoredTouch& touch : loop_.store().touches(run)) {
    const int tip = cell::tip_of_face(loop_.cell.block, recipe(), touch.plane - 1);
    tips.insert(tip);
    EXPECT_TRUE(tip == 0 || touch.role == calib::TouchRole::kFit) << "tip " << tip;
  }
  EXPECT_EQ(std::ssize(tips), cell::tip_count(recipe()));

  std::vector<calib::ContactSurface> found;
  correct_contact_planes(problem.artefact, result.artefact_errors, found);
  const calib::KinematicModel true_arm = calib::apply(loop_.cell.arm.model, truth_.errors);
  for (const calib::Touch& touch : problem.touches) {
    const int tip = cell::tip_of_face(loop_.cell.block, recipe(), touch.face);
    if (tip == 0) continue;
    const cell::ProbeTip& drawn = drawn_tip(tip);
    const Eigen::Vector3d is_m =
        forward_kinematics(true_arm, touch.joints) * (drawn.center_m + shift_m(drawn.name));
    const calib::ContactSurface& plane = found[static_cast<std::size_t>(touch.face)];
    const Eigen::Vector3d was_m =
        ball_at_m(problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)],
                  forward_kinematics(loop_.cell.arm.model, touch.joints));
    const Eigen::Vector3d here_m = ball_at_m(plane, forward_kinematics(result.calibrated, touch.joints));
    EXPECT_LE((here_m - is_m).norm(), kBallOffMax) << drawn.name;
    EXPECT_LE(10.0 * (here_m - is_m).norm(), (was_m - is_m).norm()) << drawn.name;
  }
  for (std::size_t k = 0; k < problem.artefact.parameters.size(); ++k) {
    if (problem.artefact.parameters[k].kind != calib::ArtefactKind::kTipCenter) continue;
    EXPECT_LE(result.uncertainty->artefact_std[static_cast<Eigen::Index>(k)], kBallStdMax)
        << problem.artefact.parameters[k].name;
  }
}

/// A daemon that starts again in the middle of a star's run goes on where it was.
TEST_F(StarRun, GoesOnAfterTheDaemonStartedAgain) {
  const std::int64_t run = loop_.start(kStar);
  loop_.run_until_touches(40);
  loop_.relaunch();
  ASSERT_EQ(loop_.status().state, State::kHeld);
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  loop_.command(cell::Command::kResume);
  loop_.run_until_over();
  ASSERT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  EXPECT_EQ(loop_.status().verdict, cell::Verdict::kAccepted);
  EXPECT_EQ(loop_.store().touches(run).size(), static_cast<std::size_t>(loop_.status().touches_total));
}

}  // namespace
}  // namespace touchcal::testing
