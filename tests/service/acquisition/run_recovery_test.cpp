#include "service/acquisition/run_recovery.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/commanded_touch.hpp"
#include "service/run/run_conditions.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;

class RunRecoveryTest : public ::testing::Test, public OwnersBench {
 protected:
  /// As a daemon left it that went away behind so many touches.
  std::int64_t leave_run(int touches, bool planned = true) {
    const Plan& plan = plan_of_owners();
    const std::int64_t id = store.begin_run({.recipe = "few",
                                             .started_at = "start",
                                             .config_digest = recovery_.config_digest(),
                                             .conditions_json = "{}"});
    if (planned) store.set_plan(id, static_cast<int>(plan.touches.touches.size()), plan.id, plan.document);
    for (int i = 0; i < touches; ++i) {
      const calib::PlannedTouch& touch = plan.touches.touches[static_cast<std::size_t>(i)];
      store.append_touch(id, {.number = i + 1,
                              .plane = touch.face + 1,
                              .role = touch.role,
                              .joints = to_wire(touch.joints),
                              .aimed_with = std::max(i - 1, 0)});
    }
    return id;
  }
  void hold(ActiveRun& active) {
    run(plans_.plan("few"));  // else the made-up hours pass while it is planned
    touches_.begin_run(active);
    status.enter(State::kHeld);
    status.enter(State::kUnholding);
  }

  std::optional<BlockPose> nowhere_;
  PlanCache plans_{io.get_executor(), io.get_executor(), cell_of_owners()};
  RunPlanning planning_{cell_of_owners(), nowhere_, queue, plans_, preparation, status, wake};
  TouchExecutor touches_{cell_of_owners(), computation, queue, session,      preparation,
                         block_move,       status,      wake,  time.clocks()};
  RunRecovery recovery_{cell_of_owners(), nowhere_,  regions,  queue,  plans_,       session,
                        preparation,      planning_, touches_, status, time.clocks()};
};

TEST_F(RunRecoveryTest, WithoutAnOpenRunThereIsNothingToTakeUp) { EXPECT_FALSE(recovery_.restore()); }

TEST_F(RunRecoveryTest, TakesUpTheRunWithItsTouchesAndMovesNothing) {
  const std::int64_t id = leave_run(3);
  const auto active = recovery_.restore();
  ASSERT_TRUE(active);
  EXPECT_EQ(active->run.id(), id);
  EXPECT_EQ(active->run.touches_done(), 3);
  EXPECT_EQ(active->interruption.value().plan_id, plan_of_owners().id);
  EXPECT_EQ(status.fault().value().code, FaultCode::kDaemonRestarted);
  EXPECT_TRUE(controller.asked.empty());
}

/// Who starts a daemon with other files has not decided about the run.
TEST_F(RunRecoveryTest, ARunOfOtherFilesOrOfARecipeThatIsGoneStaysOnHoldWithoutItsTouches) {
  for (const char* recipe : {"few", "gone"}) {
    const std::int64_t id =
        store.begin_run({.recipe = recipe, .started_at = "start", .config_digest = "another"});
    store.append_touch(id, {.number = 1, .plane = 99});  // of no plane of this block
    const ActiveRun active = recovery_.restore().value();
    EXPECT_TRUE(active.is_of_other_files());
    EXPECT_EQ(active.run.id(), id);
    EXPECT_EQ(active.run.recipe().name, recipe);
    EXPECT_EQ(active.run.touches_done(), 0);
    EXPECT_EQ(active.interruption.value().touches_done, 1);
    EXPECT_THAT(status.fault().value().message(), ::testing::HasSubstr("touchcal stop"));
    EXPECT_EQ(store.run(id).value().outcome, RunOutcome::kRunning);
    EXPECT_FALSE(session.open_touch());
  }
  EXPECT_THAT(controller.asked, ::testing::IsEmpty());
}

TEST_F(RunRecoveryTest, ARunWithADamagedRowIsOverAndSaysWhich) {
  const std::vector<std::string> damages{
      "UPDATE touches SET plane = 99 WHERE number = 2", "UPDATE runs SET trace_json = 'no json'",
      "UPDATE open_commands SET touch_json = '{}'", "UPDATE plan_changes SET place = 7"};
  for (const std::string& damage : damages) {
    const std::int64_t id = leave_run(3);
    store.append_plan_change(id, {PlanChange::Kind::kDefer, 4});
    store.set_open_command(id, {.session = 0, .sequence = 9, .touch_json = "{\"face\":1}"});
    store.database()->exec(damage);
    EXPECT_FALSE(recovery_.restore()) << damage;
    EXPECT_TRUE(controller.asked.empty());
    const auto outcome = store.database()
                             ->execAndGet(
                                 "SELECT outcome || coalesce(fault_message, '') FROM runs "
                                 "ORDER BY id DESC")
                             .getString();
    EXPECT_THAT(outcome, ::testing::StartsWith("interrupted")) << damage;
    if (damage.starts_with("UPDATE touches")) {
      EXPECT_THAT(outcome, ::testing::HasSubstr("table touches, run 1, number 2"));
    }
    store.database()->exec("DELETE FROM open_commands");
  }
}

TEST_F(RunRecoveryTest, ATouchOfNoPlaneOfTheBlockEndsTheRunAndIsNamed) {
  const std::int64_t id = leave_run(3);
  store.append_touch(id, {.number = 4, .plane = 99});
  EXPECT_FALSE(recovery_.restore());
  EXPECT_THAT(store.run(id).value().fault_message.value(), ::testing::HasSubstr("touch 4 is on plane 99"));
}

TEST_F(RunRecoveryTest, ATouchThatWasNotPlannedSoKeepsTheRunFromGoingOn) {
  const std::int64_t id = leave_run(3);
  const calib::PlannedTouch& other = plan_of_owners().touches.touches[9];
  const calib::PlannedTouch& fourth = plan_of_owners().touches.touches[3];
  store.append_touch(
      id, {.number = 4, .plane = fourth.face + 1, .role = fourth.role, .joints = to_wire(other.joints)});
  ActiveRun active = recovery_.restore().value();
  hold(active);
  EXPECT_FALSE(run(recovery_.make_resumable(active)));
  EXPECT_EQ(status.state(), State::kHolding) << "a person ends it";
  EXPECT_THAT(status.fault().value().message(), ::testing::HasSubstr("touch 4 is"));
}

TEST_F(RunRecoveryTest, WhyARunCannotBeResumedIsOneSentence) {
  StoredRun stored{.recipe = "few", .config_digest = "digest"};
  EXPECT_FALSE(why_not_resumable(cell_of_owners(), stored, "digest"));
  EXPECT_TRUE(why_not_resumable(cell_of_owners(), stored, "another"));
  stored.recipe = "none";
  EXPECT_TRUE(why_not_resumable(cell_of_owners(), stored, "digest"));
}

TEST_F(RunRecoveryTest, GoesOnWithTheSamePlanBehindTheSameTouches) {
  const std::int64_t id = leave_run(5);
  ActiveRun active = recovery_.restore().value();
  hold(active);
  EXPECT_TRUE(run(recovery_.make_resumable(active)));
  EXPECT_FALSE(active.interruption);
  EXPECT_EQ(active.run.next()->joints, plan_of_owners().touches.touches[5].joints);
  EXPECT_EQ(preparation.aim().touch_count(), 4u)
      << "the next one was aimed before the last contact was known";
  EXPECT_EQ(store.run(id).value().outcome, RunOutcome::kRunning);
}

TEST_F(RunRecoveryTest, ALastTouchThatTheOthersContradictIsMadeAgainBeforeAnythingElse) {
  const std::int64_t id = leave_run(24);
  const calib::PlannedTouch& last = plan_of_owners().touches.touches[24];
  const calib::JointVector beside =
      last.joints + (last.approach_joints - last.joints) * 0.8;  // millimetres before the face
  store.append_touch(
      id,
      {.number = 25, .plane = last.face + 1, .role = last.role, .joints = to_wire(beside), .aimed_with = 23});
  ActiveRun active = recovery_.restore().value();
  hold(active);
  ASSERT_TRUE(run(recovery_.make_resumable(active)));
  status.enter(State::kExecute);
  confirm(static_cast<std::uint32_t>(id));
  controller.on_touch = [this](const cs8::Touch&) { return contact(); };
  run(touches_.make_next_touch(active));
  EXPECT_EQ(active.run.touches_done(), 25) << "the repetition counts in its place";
  EXPECT_EQ(store.superseded_touches(id).size(), 1u);
}

TEST_F(RunRecoveryTest, AnAnswerThatTheControllerStillHasIsKeptFirst) {
  const std::int64_t id = leave_run(2);
  const calib::PlannedTouch& third = plan_of_owners().touches.touches[2];
  store.set_open_command(
      id, {.session = 0, .sequence = 9, .touch_json = command_text(third, {third.clear_joints})});
  ActiveRun active = recovery_.restore().value();
  hold(active);
  controller.on_query = [&](std::uint32_t) {
    cs8::TouchResult result;
    result.outcome = cs8::Outcome::kContact;
    result.source = result.first_source = cs8::CaptureSource::kLatched;
    result.contact = result.first_contact = to_wire(third.joints);
    result.search_speed_um_s = cs8::um_s_from_metres_per_second(cell_of_owners().speeds.contact_m_s());
    result.monitor_speed_percent = 100;
    result.edges = 1;
    return result;
  };
  EXPECT_TRUE(run(recovery_.make_resumable(active)));
  EXPECT_THAT(controller.asked, ElementsAre("query 9", "acknowledge 9"));
  EXPECT_EQ(active.run.touches_done(), 3);
  EXPECT_EQ(store.touches(id).back().sequence, 9u);
}

TEST_F(RunRecoveryTest, ACommandOfAnotherSessionIsLostWithIt) {
  const std::int64_t id = leave_run(2);
  const calib::PlannedTouch& third = plan_of_owners().touches.touches[2];
  store.set_open_command(
      id, {.session = 77, .sequence = 9, .touch_json = command_text(third, {third.clear_joints})});
  ActiveRun active = recovery_.restore().value();
  hold(active);
  EXPECT_TRUE(run(recovery_.make_resumable(active)));
  EXPECT_TRUE(controller.asked.empty());
  EXPECT_EQ(active.run.touches_done(), 2);
}

TEST_F(RunRecoveryTest, ARunThatWasPlannedInAnotherWayCannotGoOn) {
  const std::int64_t id = leave_run(2, false);
  store.set_plan(id, 32, "another plan", "{}");
  ActiveRun active = recovery_.restore().value();
  hold(active);
  EXPECT_FALSE(run(recovery_.make_resumable(active)));
  EXPECT_EQ(status.state(), State::kHolding) << "a person ends it";
  EXPECT_THAT(faults, ElementsAre("daemon_restarted"));
}

TEST_F(RunRecoveryTest, ARunWithoutAPlanYetIsPlanned) {
  leave_run(0, false);
  ActiveRun active = recovery_.restore().value();
  hold(active);
  EXPECT_TRUE(run(recovery_.make_resumable(active)));
  EXPECT_EQ(active.run.touches_total(), static_cast<int>(plan_of_owners().touches.touches.size()));
}

}  // namespace
}  // namespace cell
