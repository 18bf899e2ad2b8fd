// Tools whose tip a person touches the block with: the run, what it finds, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "calib_core/proof/tool_centre.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/mounted_tool.hpp"
#include "service/acquisition/preconditions.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/tool_document.hpp"
#include "service/documents/touched_tool.hpp"
#include "service/store/run_copy.hpp"
#include "tests/end_to_end/pendant.hpp"
#include "tests/end_to_end/shipped_cell.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::RunKind;
using cell::State;
using cell::Verdict;
using ::testing::HasSubstr;

constexpr const char* kTool = "gripper";

class TouchedTool : public ::testing::Test {
 protected:
  TouchedTool() { loop_.use(shipped_cell("demo"), 4'000); }

  /// Calibrates with the probe; then the tool is on the arm.
  void calibrate_and_mount() {
    loop_.serve(sim::make_plant(loop_.cell, shipped_truth("demo")),
                {.controller = {.speed = sim::kSpeedMax}, .faults = {}});
    loop_.launch();
    loop_.run_until(State::kIdle);
    calibration_ = loop_.start(kFewCandidates);
    loop_.run_until_over();
    ASSERT_EQ(loop_.store().run(calibration_)->verdict, Verdict::kAccepted);
    mounted_ = cell::with_tool_mounted(loop_.cell, kTool);
    plant_ = sim::make_plant(mounted_, shipped_truth("demo"));
    loop_.stop_serving();
    loop_.serve(plant_, {.controller = {.speed = sim::kSpeedMax}, .faults = {}});
    loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
    pendant_.emplace(loop_, mounted_, plant_);
    pendant_->take_over();
  }
  std::variant<cell::Started, cell::CommandRefusal> ask(const std::string& tool) {
    return loop_.ask_to_start({.kind = RunKind::kTool, .tool = tool, .guided = true});
  }
  std::int64_t start() {
    const auto answer = ask(kTool);
    if (const auto* refusal = std::get_if<cell::CommandRefusal>(&answer))
      throw std::runtime_error(refusal->unmet.empty() ? refusal->detail : refusal->unmet.front().detail);
    loop_.run_until([](const cell::Status& status) { return status.by_hand.has_value(); });
    return std::get<cell::Started>(answer).run.id;
  }
  void touch_as_told() {
    const cell::HandGuide guide = loop_.status().by_hand.value();
    pendant_->touch_near(guide.plane - 1, guide.about_joints.value());
    loop_.run_until([&guide](const cell::Status& status) {
      return !status.by_hand || status.by_hand->index != guide.index || status.by_hand->problem;
    });
    const auto next = loop_.status().by_hand;
    EXPECT_FALSE(next && next->problem) << (next ? next->problem.value_or("") : "");
  }
  /// Of another daemon, later than all others here: it says nothing of what is on this arm.
  void import_a_calibration() {
    cell::RunCopy copy;
    copy.run = loop_.store().run(calibration_).value();
    cell::RunImports(loop_.store().database())
        .add(copy,
             {.cell = "hall 3",
              .run_id = 7,
              .exported_at = "2026-02-01T00:00:00.000Z",
              .imported_at = "2026-02-02T00:00:00.000Z",
              .sha256 = "digest"},
             std::nullopt);
  }
  cell::ToolDocument document_of(std::int64_t run) {
    return cell::read_tool(loop_.store().result_json(run).value());
  }
  /// How far the true tip is from where the calibrated arm has it, over the workspace box; rms, metres.
  double off_m(const calib::KinematicModel& arm, const Eigen::Vector3d& tip_in_frame6_m) {
    double squares = 0.0;
    const auto postures = calib::postures_in_box(mounted_.arm.model, mounted_.arm.joint_ranges,
                                                 mounted_.workspace_box, std::nullopt, 100);
    for (const calib::JointVector& joints : postures) {
      const Eigen::Vector3d believed_m =
          calib::forward_chain(arm, joints).block_from_frame[calib::kJointCount] * tip_in_frame6_m;
      squares += (calib::forward_kinematics(plant_.truth, joints).translation() - believed_m).squaredNorm();
    }
    return std::sqrt(squares / static_cast<double>(postures.size()));
  }

  LoopbackCell loop_;
  std::int64_t calibration_ = 0;
  cell::Cell mounted_;
  sim::Plant plant_;
  calib::KinematicModel calibrated_;
  std::optional<Pendant> pendant_;
};

TEST_F(TouchedTool, IsFoundFromTheTouchesOfAPersonAndWithoutAMotionCommand) {
  calibrate_and_mount();
  const calib::IdentificationResult calibration = loop_.operation().run()->latest();
  calibrated_ = calibration.calibrated;
  const std::int64_t id = start();
  EXPECT_THAT(loop_.status().by_hand->words, HasSubstr("with the tip of the tool gripper"));
  while (loop_.status().by_hand) touch_as_told();
  loop_.run_until_over();
  EXPECT_EQ(loop_.fault_name(), "");
  const cell::StoredRun run = loop_.store().run(id).value();
  const cell::ToolDocument found = document_of(id);
  EXPECT_EQ(run.verdict, Verdict::kAccepted) << ::testing::PrintToString(found.verdict.reasons);
  EXPECT_EQ(run.of_run, calibration_);
  EXPECT_EQ(run.touches_done, calib::kToolTouchCount);
  EXPECT_EQ(cell::touching_tool(run.conditions_json), kTool);
  EXPECT_EQ(found.of_run, std::to_string(calibration_));
  const auto touched = cell::touched_tool_of("", *loop_.store().result_json(id));
  const auto& tool = std::get<cell::TouchedTool>(touched);
  const double touched_m = off_m(cell::with_tool(calibrated_, tool), tool.position_m);
  const double drawn_m = off_m(calibrated_, loop_.cell.tools.at(kTool).translation());
  EXPECT_LT(touched_m, 0.5 * drawn_m);
  EXPECT_LT(touched_m, 2.0e-3 * found.box_rms_mm.value());
  EXPECT_EQ(loop_.server().report().active_sequence, 0U);

  // Nothing moves the arm with the tool on it, nor behind a restart, until a person says that the probe is
  // back.
  import_a_calibration();
  loop_.relaunch();
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  const auto refused = [&] {
    const auto answer = loop_.ask_to_start({.recipe = kFewCandidates});
    const auto* refusal = std::get_if<cell::CommandRefusal>(&answer);
    return refusal && std::ranges::any_of(refusal->unmet, [](const cell::Unmet& one) {
             return one.code == cell::kProbeNotMounted;
           });
  };
  EXPECT_TRUE(refused());
  const auto no_search = loop_.operation().command(Command::kLocate);
  ASSERT_TRUE(no_search);
  EXPECT_THAT(no_search->detail, HasSubstr("mount the probe"));
  loop_.command(Command::kTouchTest);
  EXPECT_FALSE(refused()) << "what else the cell is not ready for is another matter";
}

TEST_F(TouchedTool, GoesOnBehindARestartAndTakesNoWordFarFromThePlane) {
  calibrate_and_mount();
  const std::int64_t id = start();
  touch_as_told();
  loop_.run_until([](const cell::Status& status) { return status.by_hand && status.by_hand->index == 2; });
  loop_.relaunch();
  loop_.run_until([](const cell::Status& status) { return status.controller.connected; });
  loop_.command(Command::kResume);
  loop_.run_until([](const cell::Status& status) { return status.by_hand.has_value(); });
  EXPECT_EQ(loop_.status().run_id, id);
  EXPECT_EQ(loop_.status().by_hand->index, 2);
  EXPECT_THAT(loop_.status().by_hand->words, HasSubstr("with the tip of the tool gripper"));
  // Wherever the arm stands now, it is no touch of that plane: the word alone makes none.
  std::string why;
  loop_.run_until([&](const cell::Status&) {  // the new daemon has to hear first where the arm is
    const auto refusal = loop_.operation().command(Command::kTake);
    why = refusal ? refusal->detail : "none";
    return why.find("has not reported") == std::string::npos;
  });
  EXPECT_THAT(why, ::testing::AllOf(HasSubstr("the tip was"), HasSubstr("plane")));
  EXPECT_EQ(loop_.status().touches_done, 1);
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
}

TEST_F(TouchedTool, TakesThePositionWhereAPersonSaysThatItTouches) {
  calibrate_and_mount();
  start();
  loop_.inject(R"({"fault":"probe_dead"})");  // a gripper trips nothing
  const cell::HandGuide guide = loop_.status().by_hand.value();
  pendant_->touch_by_word(guide.plane - 1, guide.about_joints.value(),
                          [&] { loop_.command(Command::kTake); });
  loop_.run_until([](const cell::Status& status) { return status.touches_done == 1; });
  EXPECT_EQ(loop_.store().touches(loop_.status().run_id.value()).front().noise_um, std::nullopt);
  const auto again = loop_.operation().command(Command::kTake);
  EXPECT_TRUE(again) << "once more at the same place is no other touch";
  loop_.command(Command::kUndo);
  loop_.run_until([](const cell::Status& status) { return status.touches_done == 0; });
  loop_.command(Command::kStop);
  loop_.run_until(State::kStopped);
}

TEST_F(TouchedTool, IsRefusedWithoutATipOrACalibration) {
  loop_.serve();
  loop_.launch();
  loop_.run_until(State::kIdle);
  const auto none = ask(kTool);
  ASSERT_TRUE(std::holds_alternative<cell::CommandRefusal>(none));
  EXPECT_THAT(std::get<cell::CommandRefusal>(none).unmet.front().detail,
              HasSubstr("there is no accepted calibration that a tool could be of"));
  const auto saw = ask("saw");
  ASSERT_TRUE(std::holds_alternative<cell::CommandRefusal>(saw));
  EXPECT_THAT(std::get<cell::CommandRefusal>(saw).detail, HasSubstr("the cell has no tool \"saw\""));
}

}  // namespace
}  // namespace touchcal::testing
