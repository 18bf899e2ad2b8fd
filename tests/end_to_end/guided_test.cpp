// A run whose touches a person makes with the pendant: same protocol, same core, same store, same result.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/end_to_end/pendant.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;

class GuidedRun : public ::testing::Test {
 protected:
  std::int64_t start() {
    loop_.serve();
    loop_.launch();
    loop_.run_until(State::kIdle);
    pendant_.take_over();
    const auto answer = loop_.ask_to_start(
        {.recipe = kShortRecipe, .idempotency_key = {}, .operator_name = {}, .guided = true});
    if (const auto* refusal = std::get_if<cell::CommandRefusal>(&answer))
      throw std::runtime_error(refusal->detail);
    loop_.run_until([](const cell::Status& status) { return status.by_hand.has_value(); });
    return std::get<cell::Started>(answer).run.id;
  }
  /// The touch that is asked for; the problem it was refused for.
  std::optional<std::string> touch_as_told() {
    const cell::HandGuide guide = loop_.status().by_hand.value();
    pendant_.touch_near(guide.plane - 1, guide.about_joints.value());
    loop_.run_until([&guide](const cell::Status& status) {
      return !status.by_hand || status.by_hand->index != guide.index || status.by_hand->problem;
    });
    return loop_.status().by_hand ? loop_.status().by_hand->problem : std::nullopt;
  }

  LoopbackCell loop_;
  Pendant pendant_{loop_, loop_.cell, loop_.true_plant()};
};

TEST_F(GuidedRun, IdentifiesTheArmWithoutAMotionCommand) {
  const std::int64_t id = start();
  while (loop_.status().by_hand) {
    const int done = loop_.status().touches_done;
    const auto problem = touch_as_told();
    ASSERT_FALSE(problem) << *problem;
    loop_.run_until([done](const cell::Status& status) { return status.touches_done == done + 1; });
    loop_.run_until(
        [done](const cell::Status& status) { return !status.by_hand || status.by_hand->index == done + 2; });
  }
  loop_.run_until_over();
  EXPECT_EQ(loop_.status().state, State::kComplete) << loop_.fault_name();
  // Touches by hand are exact to a tenth of a millimetre: enough to see all that the recipe's touches show.
  const calib::IdentificationResult& result = loop_.operation().run()->latest();
  ASSERT_EQ(result.status, calib::IdentificationStatus::kConverged) << result.message;
  EXPECT_EQ(result.identifiable.columns.size(), static_cast<std::size_t>(kRank));
  EXPECT_LT(result.iterations.back().residual_rms_m, 0.05 * result.iterations.front().residual_rms_m);
  const double declared_m = loop_.cell.touch_noise_m;
  std::size_t unsure = 0;
  const std::vector<cell::StoredTouch> touches = loop_.store().touches(id);
  const std::vector<calib::Touch>& fitted = loop_.operation().run()->problem().touches;
  ASSERT_EQ(touches.size(), fitted.size());
  for (std::size_t i = 0; i < touches.size(); ++i) {
    EXPECT_EQ(touches[i].source, cs8::CaptureSource::kPolled);
    EXPECT_EQ(fitted[i].deviation_m, cell::to_touch(touches[i]).deviation_m);
    if (!touches[i].noise_um) continue;  // the arm was slow enough
    ++unsure;
    EXPECT_GT(fitted[i].deviation_m, declared_m);
    EXPECT_LT(fitted[i].deviation_m, std::hypot(declared_m, 2e-4 / std::sqrt(3.0)) + 1e-7);
  }
  EXPECT_GT(unsure, touches.size() / 2);
  EXPECT_EQ(loop_.server().report().active_sequence, 0U);
  EXPECT_EQ(loop_.status().controller.mode, "manual");
}

TEST_F(GuidedRun, TakesNoTouchByWord) {
  start();
  const auto refusal = loop_.operation().command(Command::kTake);
  ASSERT_TRUE(refusal) << "a bent stylus would be a touch";
  EXPECT_EQ(refusal->kind, cell::CommandRefusal::Kind::kState);
  EXPECT_NE(refusal->detail.find("guided run"), std::string::npos) << refusal->detail;
  for (const Command command : loop_.operation().exits()) EXPECT_NE(command, Command::kTake);
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
}

TEST_F(GuidedRun, TakesNoTouchOnAnotherPlaneOrTwiceAndCanLeaveOneOut) {
  const std::int64_t id = start();
  const cell::HandGuide first = loop_.status().by_hand.value();
  const int other = first.plane == 3 ? 1 : 3;
  const calib::Face& face = loop_.cell.block.faces[static_cast<std::size_t>(other - 1)];
  pendant_.touch(other - 1, face.center_m);
  ASSERT_TRUE(loop_.status().by_hand->problem);
  EXPECT_NE(loop_.status().by_hand->problem->find("off plane"), std::string::npos)
      << *loop_.status().by_hand->problem;
  EXPECT_EQ(loop_.status().touches_done, 0);

  loop_.command(Command::kPause);
  loop_.run_until(State::kHeld);
  EXPECT_FALSE(loop_.status().by_hand);
  loop_.command(Command::kResume);
  loop_.run_until([](const cell::Status& status) { return status.by_hand.has_value(); });
  EXPECT_FALSE(touch_as_told());
  EXPECT_EQ(loop_.status().touches_done, 1);
  loop_.command(Command::kUndo);
  loop_.run_until(
      [](const cell::Status& status) { return status.touches_done == 0 && status.by_hand.has_value(); });
  EXPECT_EQ(loop_.status().by_hand->about_joints, first.about_joints);
  EXPECT_EQ(loop_.store().superseded_touches(id).size(), 1U);
  EXPECT_TRUE(loop_.is_refused(Command::kUndo));
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
}

TEST_F(GuidedRun, KeepsItsTouchesWhenTheLinkIsLost) {
  start();
  ASSERT_FALSE(touch_as_told());
  loop_.run_until([](const cell::Status& status) { return status.by_hand && status.by_hand->index == 2; });
  loop_.inject(R"({"fault":"close"})");
  loop_.run_until(State::kHeld);
  EXPECT_EQ(loop_.fault_name(), "link_lost");
  loop_.command(Command::kResume);
  loop_.run_until([](const cell::Status& status) { return status.by_hand.has_value(); });
  EXPECT_EQ(loop_.status().by_hand->index, 2);
  EXPECT_FALSE(touch_as_told());
  EXPECT_EQ(loop_.status().touches_done, 2);
}

TEST_F(GuidedRun, GoesOnByHandWhenTheDaemonWasStartedAnew) {
  const std::int64_t id = start();
  for (int done = 0; done < 2; ++done) {
    ASSERT_FALSE(touch_as_told());
    loop_.run_until(
        [done](const cell::Status& status) { return status.by_hand && status.by_hand->index == done + 2; });
  }
  const cell::HandGuide third = loop_.status().by_hand.value();
  loop_.relaunch();
  EXPECT_EQ(loop_.status().state, State::kHeld);
  EXPECT_EQ(loop_.status().eta_s, std::nullopt) << "how much is left is not known before the plan is";
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  loop_.command(Command::kResume);
  loop_.run_until([](const cell::Status& status) { return status.by_hand.has_value(); });
  EXPECT_EQ(loop_.status().run_id, id);
  EXPECT_EQ(loop_.status().by_hand->index, third.index);
  EXPECT_EQ(loop_.status().by_hand->about_joints, third.about_joints);
  EXPECT_FALSE(touch_as_told());
  EXPECT_EQ(loop_.status().touches_done, 3);
}

}  // namespace
}  // namespace touchcal::testing
