// Each invariant can fail: a record in which it is broken, and nothing else.
#include "tests/simulation/invariants.hpp"

#include <gmock/gmock.h>

namespace simulation {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using namespace std::chrono_literals;

cs8::TouchResult contact(std::int32_t joint_1) {
  cs8::TouchResult result;
  result.outcome = cs8::Outcome::kContact;
  result.contact[0] = joint_1;
  return result;
}

cell::StoredTouch touch(int number) {
  return {.number = number,
          .plane = 1,
          .joints = contact(number).contact,
          .session = 1,
          .sequence = static_cast<std::uint32_t>(number)};
}

/// An accepted run of three touches, as all invariants want it.
class InvariantTest : public ::testing::Test {
 protected:
  InvariantTest() {
    const cs8::Permit granted{.run = 1, .state = cs8::PermitState::kGranted};
    for (int number = 1; number <= 3; ++number) {
      const CommandNumber command{1, static_cast<std::uint32_t>(number)};
      record_.motions.push_back(
          {number * 10s, cs8::MessageType::kTouch, command.sequence, cell::State::kExecute, 1, granted, 5s});
      record_.answers[command] = contact(number);
      record_.acknowledged.push_back({number * 10s + 5s, command, contact(number), ""});
    }
    RunRecord run{.run = {.id = 1,
                          .touches_total = 3,
                          .outcome = cell::RunOutcome::kComplete,
                          .verdict = cell::Verdict::kAccepted},
                  .touches = {touch(1), touch(2), touch(3)},
                  .superseded = {},
                  .result_json = "result",
                  .undisturbed_json = "result"};
    record_.stores.push_back({60s, "the end", 3, {run}});
    record_.states.push_back({60s, cell::State::kComplete, {cell::Command::kStart}});
    record_.came_to_end = true;
    record_.touches_planned = 3;
  }
  RunRecord& run() { return record_.stores.back().runs.back(); }
  void expect_broken(const std::string& name) {
    EXPECT_THAT(broken_invariants(record_), ElementsAre(StartsWith(name + ": ")));
  }

  Record record_;
};

TEST_F(InvariantTest, AllHoldForARunThatWentWell) { EXPECT_THAT(broken_invariants(record_), IsEmpty()); }

TEST_F(InvariantTest, NothingMovesInAStateInWhichTheArmStands) {
  for (const auto state : {cell::State::kHeld, cell::State::kAborted, cell::State::kStopped}) {
    record_.motions[1].state = state;
    expect_broken("no_motion_in_held_aborted_stopped");
  }
}

TEST_F(InvariantTest, NothingMovesBehindAPermitThatHasEnded) {
  record_.motions[1].permit.state = cs8::PermitState::kNone;
  record_.motions[1].permit_read_at = 19s;
  expect_broken("no_motion_without_permit");
  record_.motions[1].permit_read_at = record_.motions[1].at;
  EXPECT_THAT(broken_invariants(record_), IsEmpty()) << "nobody could know";
}

TEST_F(InvariantTest, NothingMovesWithThePermitOfAnotherRun) {
  record_.motions[2].permit.run = 2;
  expect_broken("no_motion_without_permit");
}

TEST_F(InvariantTest, OnlyTheWayBackMovesWithAPermitForIt) {
  record_.motions[2].permit.state = cs8::PermitState::kRetractOnly;
  expect_broken("no_motion_without_permit");
  record_.motions[2].type = cs8::MessageType::kRetract;
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
}

TEST_F(InvariantTest, NothingButTheWayBackMovesInResettingAndNotWithThePermitOfTheRunThatIsOver) {
  record_.motions[2].state = cell::State::kResetting;
  record_.motions[2].type = cs8::MessageType::kRetract;
  expect_broken("no_motion_without_permit");
  record_.motions[2].permit.run = 0;
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
  record_.motions[2].type = cs8::MessageType::kTravel;
  expect_broken("no_motion_without_permit");
}

TEST_F(InvariantTest, ARepetitionBesideThePlanIsFoundByItsJoints) {
  record_.answers[{1, 4}] = record_.answers[{1, 5}] = contact(9);
  record_.answers[{1, 5}].contact[1] = 7;
  record_.acknowledged.push_back({46s, {1, 4}, record_.answers[{1, 4}], ""});
  record_.acknowledged.push_back({47s, {1, 5}, record_.answers[{1, 5}], ""});
  record_.stores.back().acknowledged_count = 5;
  expect_broken("answered_touches_are_durable");
  run().touches[1].again = record_.answers[{1, 4}].contact;
  expect_broken("answered_touches_are_durable");
  run().touches[0].joints = record_.answers[{1, 5}].contact;
  run().touches[0].sequence = 0;
  run().touches[2].sequence = 3;
  run().superseded.push_back({.touch = touch(1), .reason = "it did not fit"});
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
  run().touches[0].joints[2] = 1;
  EXPECT_THAT(broken_invariants(record_), ElementsAre(StartsWith("accepted_run_is_whole: "),
                                                      StartsWith("answered_touches_are_durable: ")));
}

TEST_F(InvariantTest, AnAcceptedRunHasEachTouchOfItsPlan) {
  run().run.touches_total = 4;
  expect_broken("accepted_run_is_whole");
  run().run.verdict = cell::Verdict::kIncomplete;
  EXPECT_THAT(broken_invariants(record_), IsEmpty()) << "it says so";
}

TEST_F(InvariantTest, AnAcceptedRunIsOfTheWholePlan) {
  record_.touches_planned = 4;
  expect_broken("accepted_run_is_whole");
}

TEST_F(InvariantTest, AnAcceptedRunHasNoTouchTwice) {
  run().touches[2].number = 2;
  EXPECT_THAT(broken_invariants(record_), ::testing::Contains(StartsWith("accepted_run_is_whole: ")));
}

TEST_F(InvariantTest, AnAcceptedRunHasNoTouchThatTheControllerDidNotGive) {
  run().touches[1].joints[0] += 1;
  expect_broken("accepted_run_is_whole");
  run().touches[1].joints[0] -= 1;
  record_.answers[{1, 2}].outcome = cs8::Outcome::kProbeStuck;
  expect_broken("accepted_run_is_whole");
}

TEST_F(InvariantTest, AnAcknowledgedContactIsStored) {
  run().run.verdict = cell::Verdict::kIncomplete;
  run().touches.pop_back();
  expect_broken("answered_touches_are_durable");
  record_.acknowledged[2].excuse = "warning touch_spread: 0.2 mm";
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
  record_.acknowledged[2].excuse.clear();
  const CommandNumber command = record_.acknowledged[2].command;
  run().refused.push_back({.session = command.session, .sequence = command.sequence + 1});
  expect_broken("answered_touches_are_durable");
  run().refused.back().sequence = command.sequence;
  EXPECT_THAT(broken_invariants(record_), IsEmpty()) << "kept as one that counts for nothing";
}

TEST_F(InvariantTest, ItIsStoredBehindEachKillToo) {
  StoreRecord killed = record_.stores.back();
  killed.occasion = "the daemon starts";
  killed.acknowledged_count = 2;
  killed.runs.back().run.verdict = cell::Verdict::kNone;
  killed.runs.back().run.outcome = cell::RunOutcome::kRunning;
  killed.runs.back().touches.resize(2);
  record_.stores.insert(record_.stores.begin(), killed);
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
  record_.stores.front().runs.back().touches.resize(1);
  expect_broken("answered_touches_are_durable");
}

TEST_F(InvariantTest, AnAnswerIsStoredOnceAlsoAmongThoseThatWereMadeAgain) {
  run().superseded.push_back({touch(2), "outlier"});
  expect_broken("answered_touches_are_stored_once");
}

TEST_F(InvariantTest, TouchesStandInTheOrderOfTheirCommands) {
  run().run.verdict = cell::Verdict::kIncomplete;
  std::swap(run().touches[0].sequence, run().touches[1].sequence);
  expect_broken("answered_touches_are_in_order");
}

TEST_F(InvariantTest, AResultIsThatOfItsTouches) {
  run().result_json = "another";
  expect_broken("result_is_that_of_its_touches");
  run().result_json.reset();
  expect_broken("result_is_that_of_its_touches");
}

TEST_F(InvariantTest, SomethingLeadsOutOfEachState) {
  record_.states.front().exits.clear();
  expect_broken("every_state_has_a_way_out");
}

TEST_F(InvariantTest, APersonComesToAnEnd) {
  record_.came_to_end = false;
  expect_broken("every_state_has_a_way_out");
}

TEST_F(InvariantTest, ARepeatedKeyHasTheFirstAnswerAgain) {
  const HttpAnswer first{
      .at = 10s, .request = "POST /api/v1/runs", .key = "k", .status = 201, .body = "run 1"};
  record_.http_answers = {first, first};
  record_.http_answers.push_back(
      {.at = 11s, .request = first.request, .key = "k", .status = 409, .body = "wait"});
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
  record_.http_answers[1].body = "run 2";
  expect_broken("answers_to_a_key_are_the_same");
  record_.said_answer_not_kept = true;
  EXPECT_THAT(broken_invariants(record_), IsEmpty()) << "the log says why";
}

TEST_F(InvariantTest, ARequestIsNotLeftAlone) {
  record_.http_answers = {
      {.asked_at = 10s, .at = 11s, .request = "GET /api/v1/status", .status = 200},
      {.asked_at = 10s, .at = 15s, .request = "GET /api/v1/status", .end = HttpAnswer::End::kClosed}};
  EXPECT_THAT(broken_invariants(record_), IsEmpty());
  record_.http_answers.push_back(
      {.asked_at = 10s, .at = 300s, .request = "GET /api/v1/runs", .end = HttpAnswer::End::kOpen});
  expect_broken("requests_are_answered");
}

TEST_F(InvariantTest, NothingEndsTheProcessFromWithin) {
  record_.thrown = "what nobody caught";
  record_.came_to_end = false;
  expect_broken("nothing_ends_the_process");
}

}  // namespace
}  // namespace simulation
