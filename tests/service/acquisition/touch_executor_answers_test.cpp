// Answers that are no measurement: kept, with the reason, before the controller forgets them.
#include <gmock/gmock.h>

#include "cs8_protocol/names.hpp"
#include "service/store/refused_result.hpp"
#include "tests/service/acquisition/executor_bench.hpp"

namespace cell {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class TouchExecutorAnswers : public ExecutorBench {
 protected:
  /// A contact where the touch was not asked for.
  static cs8::TouchResult elsewhere() { return contact_at(cell_of_owners().park_joints); }
  /// Its two contacts lie apart, on the line of the search.
  [[nodiscard]] cs8::TouchResult spread_contact(const cs8::Touch& command) const {
    cs8::TouchResult apart = contact();
    for (std::size_t i = 0; i < apart.contact.size(); ++i)
      apart.first_contact[i] += (command.approach[i] - apart.contact[i]) / 20;
    return apart;
  }
  [[nodiscard]] std::vector<RefusedResult> refused() const {
    return refused_results(store, active_.run.id());
  }
};

TEST_F(TouchExecutorAnswers, AnImplausibleContactIsKeptWithItsReasonBeforeItIsAcknowledged) {
  controller.on_touch = [](const cs8::Touch&) { return elsewhere(); };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kAborting);
  EXPECT_THAT(faults, ElementsAre("implausible_touch"));
  ASSERT_EQ(refused().size(), 1u);
  EXPECT_EQ(refused()[0].sequence, 1u);
  EXPECT_EQ(refused()[0].joints, elsewhere().contact);
  EXPECT_THAT(refused()[0].reason, HasSubstr("beside the search line"));
  EXPECT_THAT(controller.asked, Contains("acknowledge 1"));
  EXPECT_THAT(store.touches(active_.run.id()), IsEmpty());
}

TEST_F(TouchExecutorAnswers, ARefusedContactThatCannotBeStoredIsSettledAtTheReset) {
  controller.on_touch = [](const cs8::Touch&) { return elsewhere(); };
  status.enter(State::kExecute);
  run(touches_.make_next_touch(active_));  // the way of the command to the disk is whole yet
  EXPECT_EQ(refused().size(), 1u);

  status.enter(State::kExecute);
  faults.clear();
  controller.on_touch = [this](const cs8::Touch&) {
    break_store();
    return elsewhere();
  };
  const long before = acknowledged_count();
  run(touches_.make_next_touch(active_));
  mend_store();
  EXPECT_THAT(faults, ElementsAre("implausible_touch")) << "that ends the run, and stays to be read";
  EXPECT_EQ(status.latest().warning.value().code, FaultCode::kStoreFailed);
  EXPECT_EQ(acknowledged_count(), before) << "the controller keeps it";
  EXPECT_EQ(refused().size(), 1u);
  status.enter(State::kResetting);
  active_.open = false;
  controller.on_query = [](std::uint32_t) { return elsewhere(); };
  run(touches_.settle_open_command(&active_, session.sequence_to_settle()));
  EXPECT_EQ(acknowledged_count(), before + 1);
  EXPECT_EQ(refused().size(), 2u);
  EXPECT_EQ(status.state(), State::kResetting);
}

TEST_F(TouchExecutorAnswers, AContactThatIsMadeAgainIsKeptAsRefused) {
  controller.on_touch = [this](const cs8::Touch& command) { return spread_contact(command); };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kExecute);
  ASSERT_EQ(refused().size(), 1u);
  EXPECT_THAT(refused()[0].reason, HasSubstr("mm"));
  EXPECT_EQ(acknowledged_count(), 1);
}

TEST_F(TouchExecutorAnswers, OneThatWouldBeMadeAgainHoldsTheRunWhereItCannotBeStored) {
  controller.on_touch = [this](const cs8::Touch& command) {
    break_store();
    return spread_contact(command);
  };
  run(touches_.make_next_touch(active_));
  mend_store();
  EXPECT_EQ(status.state(), State::kHolding);
  EXPECT_THAT(faults, ElementsAre("store_failed"));
  EXPECT_EQ(touches_.held_by(), HeldBy::kTouch);
  EXPECT_EQ(acknowledged_count(), 0);
}

TEST_F(TouchExecutorAnswers, ALateContactOfAnotherRunIsKeptWithThatRun) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  ActiveRun next = planned_run();
  const cs8::TouchResult late = contact();
  controller.on_query = [&](std::uint32_t) { return late; };
  run(touches_.settle_open_command(&next, 1));
  ASSERT_EQ(refused().size(), 1u);
  EXPECT_EQ(refused()[0].joints, late.contact);
  EXPECT_THAT(refused_results(store, next.run.id()), IsEmpty());
}

TEST_F(TouchExecutorAnswers, AContactThatTheDaemonBeforeLeftBehindIsKeptWithItsEndedRun) {
  controller.on_touch = [](const cs8::Touch&) { return ScriptedController::lost(); };
  run(touches_.make_next_touch(active_));
  session.drop_open_touch();  // the next daemon knows of no command, and has no run
  const cs8::TouchResult late = contact();
  controller.on_query = [&](std::uint32_t) { return late; };
  status.enter(State::kResetting);
  break_store();
  run(touches_.settle_open_command(nullptr, 1));
  mend_store();
  EXPECT_EQ(acknowledged_count(), 0) << "the controller keeps what is not on the disk";
  EXPECT_EQ(status.state(), State::kStopped);
  status.enter(State::kResetting);
  run(touches_.settle_open_command(nullptr, 1));
  ASSERT_EQ(refused().size(), 1u);
  EXPECT_EQ(refused()[0].sequence, 1u);
  EXPECT_EQ(refused()[0].joints, late.contact);
  EXPECT_EQ(acknowledged_count(), 1);
}

TEST_F(TouchExecutorAnswers, ATouchThatTakesTooLongHoldsTheRunAndIsMadeAgainOrLeftOut) {
  const auto too_slow = [](const cs8::Touch&) {
    cs8::TouchResult result;
    result.outcome = cs8::Outcome::kDeadline;
    result.phase = cs8::Phase::kApproach;
    return result;
  };
  run(touches_.make_next_touch(active_));
  const std::size_t place = active_.run.touches_made();
  for (const Command word : {Command::kRetry, Command::kResume, Command::kSkip}) {
    controller.on_touch = too_slow;
    run(touches_.make_next_touch(active_));
    EXPECT_EQ(status.state(), State::kHolding);
    EXPECT_EQ(status.fault().value().code, FaultCode::kTouchDeadline);
    EXPECT_EQ(touches_.held_by(), HeldBy::kTouch);
    EXPECT_EQ(active_.run.touches_done(), 1) << "those before stay";
    touches_.settle_hold(active_, word);
    EXPECT_TRUE(run(touches_.store_answer(active_)));
    EXPECT_EQ(active_.run.skipped_count(), word == Command::kSkip ? 1 : 0);
    EXPECT_EQ(active_.run.touches_made(), place);
    status.enter(State::kExecute);
  }
  controller.on_touch = [this](const cs8::Touch&) { return contact(); };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 2);
}

TEST_F(TouchExecutorAnswers, AControllerThatCountsOtherwiseOrIsBusyHoldsTheRunAndIsMetAnew) {
  for (const auto reason : {cs8::RejectReason::kBusy, cs8::RejectReason::kStaleSequence}) {
    controller.on_touch = [reason](const cs8::Touch&) { return cs8::Rejected{reason, 0}; };
    status.enter(State::kExecute);
    controller.is_connected = true;
    controller.asked.clear();
    faults.clear();
    run(touches_.make_next_touch(active_));
    EXPECT_EQ(status.state(), State::kHolding) << cs8::name(reason);
    EXPECT_THAT(faults, ElementsAre("touch_rejected"));
    EXPECT_THAT(controller.asked, Contains("close")) << "its Welcome tells what it has";
    EXPECT_EQ(touches_.held_by(), HeldBy::kTouch);
    EXPECT_FALSE(session.open_touch());
  }
}

TEST_F(TouchExecutorAnswers, ThreeFalseTriggersInARunAreToldOnceAsMany) {
  controller.on_touch = [](const cs8::Touch&) {
    cs8::TouchResult noise;
    noise.outcome = cs8::Outcome::kNoContact;
    noise.edges = 1;
    return noise;
  };
  const auto is_told = [this] {
    const auto& warning = status.latest().warning;
    return warning && warning->code == FaultCode::kFalseTriggersMany;
  };
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kExecute) << "the first is made again";
  run(touches_.make_next_touch(active_));
  EXPECT_EQ(status.state(), State::kHolding) << "the second asks for a person";
  EXPECT_FALSE(is_told());
  status.enter(State::kExecute);
  run(touches_.make_next_touch(active_));
  EXPECT_TRUE(is_told());
  status.end_warning(FaultCode::kFalseTriggersMany);
  status.enter(State::kExecute);
  run(touches_.make_next_touch(active_));
  EXPECT_FALSE(is_told()) << "once in a run";
}

}  // namespace
}  // namespace cell
