// What touch_executor_beside_plan.cpp does: late answers, the reference place.
#include <gmock/gmock.h>

#include <algorithm>

#include "service/acquisition/touch_executor.hpp"
#include "service/store/refused_result.hpp"
#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;

class TouchesBesidePlan : public ExecutorBench {
 protected:
  /// Begins a run whose next touch is that of the reference place.
  void touch_until_the_reference_is_due(ActiveRun& active) {
    active.run.set_plan(plan_of_owners().touches);
    touches_.begin_run(active);
    while (active.run.touches_done() == 0) run(touches_.make_next_touch(active));
  }
  void touch_at_a_broken_store(ActiveRun& active) {
    break_store();
    run(touches_.make_next_touch(active));
    mend_store();
  }
  /// A contact on the line of the search, further from that of the plan's own touch than drift explains.
  [[nodiscard]] cs8::TouchResult biased_contact(const cs8::Touch& command) const {
    cs8::TouchResult biased = contact();
    for (std::size_t i = 0; i < biased.contact.size(); ++i)
      biased.contact[i] += (command.approach[i] - biased.contact[i]) / 20;
    biased.first_contact = biased.contact;
    return biased;
  }
  /// The controller's application is started anew: what it had not been thanked for it has forgotten.
  void start_controller_anew(const ActiveRun& active) {
    controller.on_connect = [number = session.number() + 1] {
      cs8::Welcome welcome;
      welcome.session = number;
      return welcome;
    };
    run(session.connect(false));
    confirm(static_cast<std::uint32_t>(active.run.id()));
    status.enter(State::kExecute);
  }
};

TEST_F(TouchesBesidePlan, AnAnswerThatWasLostIsAskedForAndItsTouchCountsOnce) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  const auto made = contact();
  status.raise({FaultCode::kLinkLost, {}}, Event::kLinkDown);
  ASSERT_TRUE(session.open_touch());
  controller.on_query = [&](std::uint32_t) { return made; };
  run(touches_.settle_open_command(&active_, session.sequence_to_settle()));
  EXPECT_EQ(active_.run.touches_done(), 1);
  EXPECT_FALSE(session.open_touch());
  status.enter(State::kExecute);
  controller.on_touch = [this](const cs8::Touch&) { return contact(); };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 2);
}

TEST_F(TouchesBesidePlan, ACollisionThatIsToldOnceTheLinkIsBackEndsTheRun) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  status.raise({FaultCode::kLinkLost, {}}, Event::kLinkDown);
  controller.on_query = [](std::uint32_t) {
    cs8::TouchResult result;
    result.outcome = cs8::Outcome::kCollision;
    return result;
  };
  run(touches_.settle_open_command(&active_, session.sequence_to_settle()));
  EXPECT_EQ(status.state(), State::kAborting);
  EXPECT_THAT(faults, ElementsAre("link_lost", "collision"));
  EXPECT_FALSE(session.open_touch());
}

// The way to the reference place, say: nobody here has it open.
TEST_F(TouchesBesidePlan, ACollisionOfAMotionThatTheLinkDidNotOutliveEndsTheRunToo) {
  status.raise({FaultCode::kLinkLost, {}}, Event::kLinkDown);
  for (const auto outcome : {cs8::Outcome::kStopped, cs8::Outcome::kCollision}) {
    controller.on_query = [outcome](std::uint32_t) {
      cs8::MoveResult result;
      result.outcome = outcome;
      return result;
    };
    run(touches_.settle_open_command(&active_, 4));
    EXPECT_EQ(status.state() == State::kAborting, outcome == cs8::Outcome::kCollision);
  }
  EXPECT_THAT(faults, ElementsAre("link_lost", "collision"));
}

TEST_F(TouchesBesidePlan, AfterALostLinkTheTouchIsOpenUntilItsAnswerIsKept) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  ASSERT_TRUE(session.open_touch());
  EXPECT_EQ(active_.run.touches_done(), 0);
  EXPECT_TRUE(faults.empty()) << "the controller's hook tells it";
  controller.on_query = [this](std::uint32_t) { return contact(); };
  run(touches_.settle_open_command(&active_, 1));
  EXPECT_EQ(active_.run.touches_done(), 1);
  EXPECT_THAT(controller.asked, ElementsAre("touch 1", "query 1", "acknowledge 1"));
}

TEST_F(TouchesBesidePlan, AnOpenCommandThatIsNotOursIsForgottenUnread) {
  controller.on_query = [this](std::uint32_t) { return cs8::TouchResult{}; };
  run(touches_.settle_open_command(nullptr, 5));
  EXPECT_THAT(controller.asked, ElementsAre("query 5", "acknowledge 5"));
  EXPECT_EQ(active_.run.touches_done(), 0);
}

TEST_F(TouchesBesidePlan, ALateTouchOfAnotherRunIsNotKeptByThisOne) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  ASSERT_TRUE(session.open_touch());
  ActiveRun next = planned_run();
  controller.on_query = [this](std::uint32_t) { return contact(); };
  run(touches_.settle_open_command(&next, 1));
  EXPECT_EQ(next.run.touches_done(), 0);
  EXPECT_TRUE(store.touches(next.run.id()).empty());
}

TEST_F(TouchesBesidePlan, ACommandThatWasNeverTakenLeavesItsNumberToTheNext) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  ASSERT_TRUE(store.open_command(active_.run.id()));
  controller.on_query = [](std::uint32_t) { return cs8::ResultUnknown{}; };
  run(touches_.settle_open_command(&active_, 1));
  EXPECT_FALSE(session.open_touch());
  EXPECT_FALSE(store.open_command(active_.run.id()));
}

TEST_F(TouchesBesidePlan, TheWayFromTheReferencePlaceKnowsAContactThatWasKeptLate) {
  ActiveRun active = begun_run("edf-25");
  active.run.set_plan(plan_of_owners().touches);
  touches_.begin_run(active);
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active));
  const auto made = contact();
  controller.on_query = [&](std::uint32_t) { return made; };
  run(touches_.settle_open_command(&active, session.open_touch().value().sequence));
  ASSERT_EQ(active.run.touches_done(), 1);
  preparation.drop_next();  // as behind a contact that was a surprise
  status.enter(State::kExecute);
  controller.on_touch = [this](const cs8::Touch&) { return contact(); };
  run(touches_.make_next_touch(active));
  ASSERT_EQ(store.references(active.run.id()).size(), 1U);
  EXPECT_EQ(preparation.aim().touch_count(), 1U);
  EXPECT_EQ(preparation.next()->aimed_with, 1);
}

TEST_F(TouchesBesidePlan, AContactAtTheReferencePlaceIsAcknowledgedOnceItIsStored) {
  ActiveRun active = begun_run("edf-25");
  touch_until_the_reference_is_due(active);
  const long before = acknowledged_count();
  const auto touches_sent = [this] {
    return std::ranges::count_if(controller.asked,
                                 [](const std::string& one) { return one.starts_with("touch"); });
  };
  const long sent = touches_sent();
  touch_at_a_broken_store(active);
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_EQ(touches_sent(), sent + 1);
  EXPECT_EQ(acknowledged_count(), before);
  EXPECT_TRUE(store.references(active.run.id()).empty());
  status.enter(State::kExecute);
  run(touches_.make_next_touch(active));
  EXPECT_EQ(touches_sent(), sent + 1) << "it is not touched twice";
  EXPECT_EQ(acknowledged_count(), before + 1);
  ASSERT_EQ(store.references(active.run.id()).size(), 1u);
  EXPECT_EQ(store.references(active.run.id())[0].number, 1);
}

TEST_F(TouchesBesidePlan, AContactThatItsRunCouldNotStoreIsNotForgottenWithTheRun) {
  ActiveRun active = begun_run("edf-25");
  touch_until_the_reference_is_due(active);
  const long before = acknowledged_count();
  touch_at_a_broken_store(active);
  const cs8::TouchResult made = contact();
  controller.on_query = [&](std::uint32_t) { return made; };
  const std::uint32_t sequence = session.sequence_to_settle();
  ASSERT_NE(sequence, 0u);
  run(touches_.settle_open_command(&active, sequence));
  EXPECT_EQ(acknowledged_count(), before) << "the run has it, and stores it when it goes on";
  EXPECT_THAT(refused_results(store, active.run.id()), ::testing::IsEmpty());
  active.open = false;
  status.enter(State::kResetting);
  run(touches_.settle_open_command(&active, sequence));
  ASSERT_EQ(refused_results(store, active.run.id()).size(), 1u);
  EXPECT_EQ(refused_results(store, active.run.id())[0].joints, made.contact);
  EXPECT_EQ(acknowledged_count(), before + 1);
  EXPECT_EQ(session.sequence_to_settle(), 0u);
}

TEST_F(TouchesBesidePlan, AContactThatIsNoReferenceIsKeptThoughTheControllerForgetsIt) {
  ActiveRun active = begun_run("edf-25");
  touch_until_the_reference_is_due(active);
  cs8::TouchResult made;
  controller.on_touch = [&](const cs8::Touch& command) { return made = biased_contact(command); };
  const std::uint32_t before = session.number();
  touch_at_a_broken_store(active);
  ASSERT_EQ(status.latest().warning.value().code, FaultCode::kFirstTouchBiased);
  EXPECT_EQ(status.state(), State::kHolding) << "it is not on the disk";
  EXPECT_THAT(refused_results(store, active.run.id()), ::testing::IsEmpty());

  start_controller_anew(active);
  controller.on_touch = [this](const cs8::Touch&) { return contact(); };
  run(touches_.make_next_touch(active));
  const auto kept = refused_results(store, active.run.id());
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].session, before);
  EXPECT_EQ(kept[0].joints, made.contact);
  EXPECT_THAT(kept[0].reason, ::testing::HasSubstr(describe(FaultCode::kFirstTouchBiased).cause));
  EXPECT_EQ(store.references(active.run.id()).size(), 1U) << "the place is touched again";
}

TEST_F(TouchesBesidePlan, ARunThatBeginsForgetsNoContactOfTheOneBefore) {
  ActiveRun active = begun_run("edf-25");
  touch_until_the_reference_is_due(active);
  const long before = acknowledged_count();
  touch_at_a_broken_store(active);
  touches_.begin_run(active_);
  EXPECT_EQ(acknowledged_count(), before) << "it is not on the disk";
  EXPECT_NE(session.sequence_to_settle(), 0u);
}

TEST_F(TouchesBesidePlan, TheReferencePlaceIsTouchedBesideThePlan) {
  ActiveRun active = begun_run("edf-25");
  ASSERT_GT(active.run.recipe().reference_every, 0);
  active.run.set_plan(plan_of_owners().touches);
  touches_.begin_run(active);
  while (active.run.touches_done() == 0 || store.references(active.run.id()).empty())
    run(touches_.make_next_touch(active));
  const int done = active.run.touches_done();
  EXPECT_EQ(static_cast<int>(store.touches(active.run.id()).size()), done);
  EXPECT_EQ(store.references(active.run.id()).at(0).touches_done, done);
  EXPECT_FALSE(status.latest().reference_drift_m) << "drift counts from the first";
  EXPECT_EQ(acknowledged_count(), done + 1);
}

}  // namespace
}  // namespace cell
