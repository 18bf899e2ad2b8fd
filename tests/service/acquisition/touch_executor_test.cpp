#include "service/acquisition/touch_executor.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <functional>
#include <utility>

#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using TouchExecutorTest = ExecutorBench;

TEST_F(TouchExecutorTest, AContactIsStoredThenAddedThenAcknowledged) {
  controller.on_touch = [this](const cs8::Touch&) {
    EXPECT_TRUE(store.open_command(active_.run.id())) << "kept before it was sent";
    return contact();
  };
  run(touches_.make_next_touch(active_));
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1"));
  EXPECT_EQ(active_.run.touches_done(), 1);
  const StoredTouch stored = store.touches(active_.run.id()).at(0);
  EXPECT_EQ(stored.sequence, 1u);
  EXPECT_EQ(stored.plane, plan_of_owners().touches.touches[0].face + 1);
  EXPECT_FALSE(session.open_touch());
}

TEST_F(TouchExecutorTest, TheNextCommandIsStoredOnTheWayOfTheContactBeforeIt) {
  run(touches_.make_next_touch(active_));
  const auto next = store.open_command(active_.run.id());
  ASSERT_TRUE(next);
  EXPECT_EQ(next->sequence, 2u);
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1")) << "it leaves in its turn";
  break_store();  // what leaves now must have been stored before
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  mend_store();
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1", "touch 2"));
  EXPECT_EQ(session.open_touch().value().sequence, 2u);
}

/// The arithmetic goes on when the test lets it.
class WaysBesideTheLink : public ExecutorBench {
 protected:
  void begin_touch() {
    boost::asio::co_spawn(io, executor_.make_next_touch(active_),
                          [this](const std::exception_ptr& failure) { has_ended_ = !failure; });
    let_run();
  }
  void compute() {
    arithmetic_.restart();
    EXPECT_EQ(arithmetic_.run(), 1u);
    let_run();
  }
  void let_run() {
    io.restart();
    io.poll();
  }

  boost::asio::io_context arithmetic_{1};
  RunComputation beside_{arithmetic_.get_executor(), regions, status, std::make_unique<MadeUpAlarm>()};
  TouchExecutor executor_{cell_of_owners(), beside_, queue, session,      preparation,
                          block_move,       status,  wake,  time.clocks()};
  bool has_ended_ = false;
};

TEST_F(WaysBesideTheLink, BehindAStopNothingLeaves) {
  begin_touch();
  EXPECT_FALSE(has_ended_);
  status.enter(State::kStopping);
  compute();
  EXPECT_TRUE(has_ended_);
  EXPECT_THAT(controller.asked, ::testing::IsEmpty());
}

TEST_F(WaysBesideTheLink, AreLookedForAnewWhereTheArmWasMovedMeanwhile) {
  begin_touch();
  controller.state->joints[0] += 2'000'000;
  tell_state();
  compute();
  EXPECT_TRUE(has_ended_);
  EXPECT_THAT(controller.asked, ::testing::IsEmpty());
  begin_touch();
  compute();
  EXPECT_THAT(controller.asked, ElementsAre("touch 1"));
}

TEST_F(WaysBesideTheLink, AContactIsStoredMeanwhileAndBehindAHoldNoCommandFollowsIt) {
  begin_touch();
  compute();  // the way to it
  EXPECT_THAT(controller.asked, ElementsAre("touch 1"));
  compute();  // what comes behind it, while the arm moves
  EXPECT_EQ(store.touches(active_.run.id()).size(), 1U) << "the disk waits for no arithmetic";
  EXPECT_EQ(active_.run.touches_done(), 0);
  status.enter(State::kHolding);
  compute();  // what the contact changes
  EXPECT_TRUE(has_ended_);
  EXPECT_EQ(active_.run.touches_done(), 1);
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1"));
  EXPECT_FALSE(store.open_command(active_.run.id()));
}

TEST_F(TouchExecutorTest, AStopWhileAContactIsStoredKeepsTheCommandBehindItFromLeaving) {
  controller.on_touch = [this](const cs8::Touch&) {
    queue.behind([this](RunStore&) { status.enter(State::kStopping); });
    return contact();
  };
  run(touches_.make_next_touch(active_));
  expect_run_is_as_stored();
  EXPECT_EQ(active_.run.touches_done(), 1);
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1"));
  EXPECT_FALSE(store.open_command(active_.run.id())) << "the next command has its number";
}

TEST_F(TouchExecutorTest, AnArmThatIsMovedIsNotCommandedFromWhereItStood) {
  run(touches_.make_next_touch(active_));
  session.forget_standing();
  controller.state->joints = to_wire(cell_of_owners().park_joints);
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 2);
  EXPECT_EQ(store.open_command(active_.run.id()).value().sequence, 3u);
  expect_run_is_as_stored();
}

// While the contact is committed, a State tells that the arm is elsewhere.
TEST_F(TouchExecutorTest, AnArmThatIsMovedWhileTheDiskIsWrittenIsNotCommandedFromWhereItStood) {
  bool is_answered = false;
  controller.on_touch = [&](const cs8::Touch&) {
    is_answered = true;
    return contact();
  };
  std::function<void()> move = [&] {
    if (!session.standing() || !std::exchange(is_answered, false)) return;  // the contact is not stored yet
    controller.state->joints = to_wire(cell_of_owners().park_joints);
    tell_state();
  };
  sqlite3_commit_hook(
      store.database()->getHandle(),
      [](void* moves) {
        (*static_cast<std::function<void()>*>(moves))();
        return 0;
      },
      &move);
  run(touches_.make_next_touch(active_));
  mend_store();
  EXPECT_EQ(active_.run.touches_done(), 1);
  EXPECT_FALSE(session.standing());
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kArmMoved);
}

TEST_F(TouchExecutorTest, TheNextTouchIsReadyWhenTheArmComesBack) {
  run(touches_.make_next_touch(active_));
  const int waits = wake.wait_count;
  for (int i = 0; i < 3; ++i) run(touches_.make_next_touch(active_));
  EXPECT_EQ(wake.wait_count, waits) << "where the arm stands is known, and the way from there";
  EXPECT_EQ(active_.run.touches_done(), 4);
}

TEST_F(TouchExecutorTest, AnArmThatCannotLeaveWhereItStandsHoldsTheRunUntilAPersonJogsIt) {
  run(touches_.make_next_touch(active_));
  // On hold somebody moved it to where its links are in the block.
  controller.state->joints = to_wire(plan_of_owners().touches.touches[5].search_end_joints);
  session.forget_standing();
  controller.asked.clear();
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("no_safe_way"));
  EXPECT_THAT(status.fault().value().detail, ::testing::HasSubstr("no room to leave"));
  EXPECT_EQ(touches_.held_by(), HeldBy::kTouch);
  EXPECT_THAT(controller.asked, ::testing::IsEmpty()) << "nothing was commanded";
  EXPECT_THAT(active_.run.plan_changes(), ::testing::IsEmpty()) << "no touch of the plan is to blame";
  controller.state->joints = to_wire(cell_of_owners().park_joints);
  status.enter(State::kExecute);
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 2);
}

TEST_F(TouchExecutorTest, WithoutATouchLeftTheStepIsDone) {
  while (active_.run.next()) active_.run.skip_next();
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kCompleting);
  EXPECT_TRUE(controller.asked.empty());
}

/// The n-th commit to the store fails, for n = 1, 2, 3, ... until a sweep of three touches meets no failure.
TEST_F(TouchExecutorTest, WhereverTheStoreBreaksNoTouchIsAcknowledgedThatIsNotStored) {
  struct Breaker {
    int left = 0;
    bool broke = false;
  } breaker;
  sqlite3_commit_hook(
      store.database()->getHandle(),
      [](void* data) {
        auto& its = *static_cast<Breaker*>(data);
        const bool breaks = --its.left == 0;
        its.broke = its.broke || breaks;
        return breaks ? 1 : 0;
      },
      &breaker);
  int sweeps = 0;
  do {
    ++sweeps;
    const int done_before = active_.run.touches_done();
    const long acknowledged_before = acknowledged_count();
    breaker = {.left = sweeps};
    for (int touch = 0; touch < 3 && status.state() == State::kExecute; ++touch)
      run(touches_.make_next_touch(active_));
    breaker.left = 0;
    expect_run_is_as_stored();
    EXPECT_EQ(acknowledged_count() - acknowledged_before, active_.run.touches_done() - done_before) << sweeps;
    EXPECT_TRUE(breaker.broke || status.state() == State::kExecute) << sweeps << ": nothing else is a fault";
    // A touch that the controller has still is settled, as behind a reset.
    if (session.open_touch()) {
      controller.on_query = [this](std::uint32_t) { return contact(); };
      run(touches_.settle_open_command(&active_, session.sequence_to_settle()));
      expect_run_is_as_stored();
      EXPECT_FALSE(session.open_touch());
    }
    status.enter(State::kExecute);
    session.forget_standing();
  } while (breaker.broke && sweeps < 20);
  EXPECT_GT(sweeps, 3);
  EXPECT_LT(sweeps, 20);
  sqlite3_commit_hook(store.database()->getHandle(), nullptr, nullptr);
}

TEST_F(TouchExecutorTest, ACommandThatCannotBeKeptDoesNotLeave) {
  sqlite3_commit_hook(
      store.database()->getHandle(), [](void*) { return 1; }, nullptr);
  run(touches_.make_next_touch(active_));
  sqlite3_commit_hook(store.database()->getHandle(), nullptr, nullptr);
  EXPECT_TRUE(controller.asked.empty());
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("store_failed"));
}

TEST_F(TouchExecutorTest, ATouchThatNobodyPermitsAnyMoreDoesNotLeave) {
  controller.permit = cs8::Permit{.run = 1, .reason = cs8::PermitReason::kPermissionLost};
  run(touches_.make_next_touch(active_));
  EXPECT_THAT(controller.asked, IsEmpty());
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("permission_lost"));
  EXPECT_FALSE(session.open_touch() || store.open_command(active_.run.id())) << "it was never made";
  controller.permit = ScriptedController::granted(1);
  status.enter(State::kExecute);
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 1);
}

TEST_F(TouchExecutorTest, ATouchThatMeetsNothingHoldsTheRunAndIsForgottenByTheController) {
  controller.on_touch = [](const cs8::Touch&) {
    cs8::TouchResult nothing;
    nothing.outcome = cs8::Outcome::kNoContact;
    return nothing;
  };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_EQ(touches_.held_by(), HeldBy::kTouch);
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "acknowledge 1"));
  EXPECT_EQ(active_.run.touches_done(), 0);
  const std::size_t place = active_.run.touches_made();
  const int total = active_.run.touches_total();
  touches_.settle_hold(active_, Command::kSkip);
  EXPECT_TRUE(run(touches_.store_answer(active_)));
  EXPECT_EQ(active_.run.skipped_count(), 1);
  ASSERT_EQ(store.plan_changes(active_.run.id()).size(), 1u) << "a person's word outlives the daemon at once";
  EXPECT_EQ(store.plan_changes(active_.run.id())[0].kind, PlanChange::Kind::kSkip);
  EXPECT_EQ(active_.stored_changes, 1u);
  EXPECT_EQ(active_.run.touches_made(), place);
  EXPECT_EQ(active_.run.touches_total(), total);
  EXPECT_EQ(touches_.held_by(), HeldBy::kNothing);
}

TEST_F(TouchExecutorTest, ARejectionHoldsOrEndsTheRunByItsReason) {
  controller.on_touch = [](const cs8::Touch&) {
    return cs8::Rejected{cs8::RejectReason::kProbeTriggered, 0};
  };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_FALSE(session.open_touch());
  EXPECT_FALSE(store.open_command(active_.run.id())) << "the next command has its number";
  status.enter(State::kExecute);
  controller.on_touch = [](const cs8::Touch&) { return cs8::Rejected{cs8::RejectReason::kBadField, 0}; };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kAborting);
}

TEST_F(TouchExecutorTest, ATouchThatTheOthersContradictIsMadeAgainAndReplaced) {
  constexpr int kBefore = 24;
  for (int i = 0; i < kBefore; ++i) run(touches_.make_next_touch(active_));
  ASSERT_EQ(active_.run.touches_done(), kBefore) << (faults.empty() ? "" : faults.back());
  controller.on_touch = [this](const cs8::Touch& command) {
    cs8::TouchResult beside = contact();  // a millimetre or so before the face, on the line of its search
    for (std::size_t i = 0; i < beside.contact.size(); ++i)
      beside.contact[i] += (command.approach[i] - beside.contact[i]) / 3;
    beside.first_contact = beside.contact;
    return beside;
  };
  run(touches_.make_next_touch(active_));
  ASSERT_EQ(active_.run.touches_done(), kBefore + 1) << (faults.empty() ? "" : faults.back());
  const cs8::JointsMicrodeg beside = active_.run.touches().back().joints;
  controller.on_touch = [this](const cs8::Touch&) { return contact(); };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), kBefore + 1) << "the repetition counts in its place";
  EXPECT_NE(active_.run.touches().back().joints, beside);
  EXPECT_EQ(store.superseded_touches(active_.run.id()).size(), 1u);
  expect_run_is_as_stored();
}

TEST_F(TouchExecutorTest, AWordThatCannotBeStoredChangesNothing) {
  controller.on_touch = [](const cs8::Touch&) {
    cs8::TouchResult nothing;
    nothing.outcome = cs8::Outcome::kNoContact;
    return nothing;
  };
  run(touches_.make_next_touch(active_));
  break_store();
  touches_.settle_hold(active_, Command::kSkip);
  EXPECT_FALSE(run(touches_.store_answer(active_)));
  mend_store();
  EXPECT_EQ(active_.run.skipped_count(), 0);
  EXPECT_EQ(touches_.held_by(), HeldBy::kTouch) << "it can be said again";
  touches_.settle_hold(active_, Command::kSkip);
  EXPECT_TRUE(run(touches_.store_answer(active_)));
  EXPECT_EQ(active_.run.skipped_count(), 1);
}

TEST_F(TouchExecutorTest, AStopWhileTheDiskIsWrittenKeepsTheCommandFromLeaving) {
  const auto stop_behind_the_write = [this](RunStore&) { status.enter(State::kStopping); };
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  // One executor for all: what is queued here is done before the command's own write.
  queue.behind(stop_behind_the_write);
  run(touches_.make_next_touch(active_));
  EXPECT_THAT(controller.asked, ElementsAre()) << "nothing was sent";
  EXPECT_FALSE(store.open_command(active_.run.id())) << "the next command has its number";
  EXPECT_FALSE(session.open_touch());
  EXPECT_TRUE(faults.empty());
}

TEST_F(TouchExecutorTest, ALockThatAnotherProgramLetsGoOfDelaysTheRunAndHoldsNothing) {
  SQLite::Database other((folder.path() / "touchcal.sqlite").string(), SQLite::OPEN_READWRITE);
  controller.on_touch = [&](const cs8::Touch&) {
    const auto locked_at = time.since_begin();
    other.exec("BEGIN IMMEDIATE");
    on_lock_wait = [this, &other, locked_at] {
      EXPECT_EQ(acknowledged_count(), 0) << "the controller keeps it";
      if (time.since_begin() - locked_at < std::chrono::milliseconds(800)) return;
      other.exec("ROLLBACK");
      on_lock_wait = nullptr;
    };
    return contact();
  };
  run(touches_.make_next_touch(active_));
  EXPECT_FALSE(on_lock_wait) << "it was waited for";
  EXPECT_EQ(status.state(), State::kExecute);
  EXPECT_TRUE(faults.empty());
  EXPECT_EQ(active_.run.touches_done(), 1);
  expect_run_is_as_stored();
  EXPECT_EQ(acknowledged_count(), 1);
}

TEST_F(TouchExecutorTest, ALockOfAnotherProgramHoldsTheRunAndTheContactIsKeptOnceItIsGone) {
  SQLite::Database other((folder.path() / "touchcal.sqlite").string(), SQLite::OPEN_READWRITE);
  controller.on_touch = [&](const cs8::Touch&) {
    other.exec("BEGIN IMMEDIATE");
    return contact();
  };
  run(touches_.make_next_touch(active_));
  EXPECT_GE(time.since_begin(), kLockPatience) << "it was waited for";
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("store_failed"));
  EXPECT_EQ(acknowledged_count(), 0) << "the controller keeps it";
  EXPECT_EQ(preparation.aim().touch_count(), 0u) << "it does not count";
  EXPECT_EQ(store.open_command(active_.run.id()).value().sequence, 1u) << "no command went along";
  other.exec("ROLLBACK");
  status.enter(State::kHeld);
  status.enter(State::kUnholding);
  controller.on_query = [this](std::uint32_t) { return contact(); };
  run(touches_.settle_open_command(&active_, session.open_touch().value().sequence));
  EXPECT_EQ(active_.run.touches_done(), 1);
  expect_run_is_as_stored();
  EXPECT_EQ(acknowledged_count(), 1);
}

}  // namespace
}  // namespace cell
