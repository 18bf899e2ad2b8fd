// A controller that goes, is silent or talks nonsense in the middle of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"
#include "tests/end_to_end/loopback_cell.hpp"
#include "tests/end_to_end/relay.hpp"
#include "tests/end_to_end/stored_touches.hpp"

namespace touchcal::testing {
namespace {

using cell::Command;
using cell::State;
using cs8::MessageType;
using sim::Fault;

/// How far the controller came with the n-th touch when the fault cut it off.
enum class Reached {
  kNotMade,   // the daemon asked, and nothing came of it
  kUntold,    // made, and its result waits at the controller until the daemon is back
  kCaptured,  // stored before
};

/// What a fault at the n-th message of a type makes of the run.
struct LinkCase {
  Fault fault;
  MessageType on;
  std::vector<std::string> expected;  // fault code; two where a busy machine may miss either first
  Reached reached;
};

std::string describe(const LinkCase& link_case, std::uint32_t nth) {
  static const std::map<Fault, std::string> kNames{{Fault::kCloseSocket, "closes"},
                                                   {Fault::kGoSilent, "goes silent"},
                                                   {Fault::kGarbage, "sends garbage"},
                                                   {Fault::kDrop, "drops"},
                                                   {Fault::kWrongSequence, "numbers wrongly"}};
  return "the controller " + kNames.at(link_case.fault) + " at " + std::string(cs8::name(link_case.on)) +
         " " + std::to_string(nth);
}

/// A run that meets the fault, waits with its touches and goes on when a person says so. `before` touches are
/// made in peace.
void meet(const LinkCase& link_case, std::uint32_t nth, int before) {
  SCOPED_TRACE(describe(link_case, nth));
  const int captured = before + (link_case.reached == Reached::kCaptured ? 1 : 0);
  const int kept = before + (link_case.reached == Reached::kNotMade ? 0 : 1);
  LoopbackCell loop;
  loop.cell.deadlines.command = std::chrono::milliseconds(100);
  loop.serve({{link_case.fault, link_case.on, nth}});
  loop.launch();
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until_over();
  ASSERT_EQ(loop.status().state, State::kHeld);
  expect_touches_once(loop, id, captured);
  // Of a controller that is silent, the daemon tells first that there is no State any more.
  const auto is_told = [&] { return std::ranges::count(link_case.expected, loop.fault_name()) > 0; };
  loop.run_until([&](const cell::Status&) { return is_told(); });
  EXPECT_EQ(loop.store().run(id)->outcome, cell::RunOutcome::kRunning);

  loop.run_until(
      [&](const cell::Status& status) { return status.controller.connected && status.touches_done >= kept; });
  EXPECT_EQ(loop.status().state, State::kHeld) << "a link alone moves nothing";
  EXPECT_TRUE(is_told()) << "until a person resumes: " << loop.fault_name();
  expect_touches_once(loop, id, kept);
  loop.command(Command::kResume);
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  expect_touches_once(loop, id, kShortTouchCount);
  EXPECT_EQ(loop.store().runs(10).size(), 1U);
}

void meet_at_touches(const LinkCase& link_case, std::initializer_list<int> touches) {
  for (const int nth : touches) meet(link_case, static_cast<std::uint32_t>(nth), nth - 1);
}

TEST(LinkFaults, AControllerThatClosesHoldsTheRunAtAnyTouch) {
  const auto touches = {1, 2, 17, kShortTouchCount};
  meet_at_touches({Fault::kCloseSocket, MessageType::kTouch, {"link_lost"}, Reached::kNotMade}, touches);
  meet_at_touches({Fault::kCloseSocket, MessageType::kAccepted, {"link_lost"}, Reached::kUntold}, touches);
  meet_at_touches({Fault::kCloseSocket, MessageType::kTouchResult, {"link_lost"}, Reached::kUntold}, touches);
}

TEST(LinkFaults, AControllerThatClosesWhenItMayForgetAResultHasGivenItAlready) {
  meet_at_touches({Fault::kCloseSocket, MessageType::kResultAcknowledge, {"link_lost"}, Reached::kCaptured},
                  {1, 17, kShortTouchCount});
}

TEST(LinkFaults, ASilentControllerHoldsTheRunAtAnyTouch) {
  for (const MessageType on : {MessageType::kTouch, MessageType::kTouchResult}) {
    meet_at_touches({Fault::kGoSilent, on, {"link_lost", "answer_missing"}, Reached::kUntold},
                    {1, kShortTouchCount});
  }
}

TEST(LinkFaults, BytesThatAreNoFrameHoldTheRunAtAnyTouch) {
  const auto touches = {1, 17, kShortTouchCount};
  meet_at_touches({Fault::kGarbage, MessageType::kTouch, {"protocol_error"}, Reached::kNotMade}, touches);
  meet_at_touches({Fault::kGarbage, MessageType::kAccepted, {"protocol_error"}, Reached::kUntold}, touches);
  meet_at_touches({Fault::kGarbage, MessageType::kTouchResult, {"protocol_error"}, Reached::kUntold},
                  touches);
}

TEST(LinkFaults, AnAnswerToNothingThatWasAskedHoldsTheRunAtAnyTouch) {
  const auto touches = {1, 17, kShortTouchCount};
  // A touch that was made under another number is not the one that was asked for.
  meet_at_touches({Fault::kWrongSequence, MessageType::kTouch, {"protocol_error"}, Reached::kNotMade},
                  touches);
  meet_at_touches({Fault::kWrongSequence, MessageType::kAccepted, {"protocol_error"}, Reached::kUntold},
                  touches);
  meet_at_touches({Fault::kWrongSequence, MessageType::kTouchResult, {"protocol_error"}, Reached::kUntold},
                  touches);
}

TEST(LinkFaults, AnAnswerThatDoesNotComeHoldsTheRun) {
  meet_at_touches({Fault::kDrop, MessageType::kTouch, {"answer_missing"}, Reached::kNotMade}, {1});
}

TEST(LinkFaults, AResultThatIsLostOnItsWayIsAskedForAndTheRunIsWhole) {
  LoopbackCell loop;
  loop.serve({{Fault::kDrop, MessageType::kTouchResult, 17}});
  loop.launch();
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  expect_touches_once(loop, id, kShortTouchCount);
}

TEST(LinkFaults, AControllerThatDoesNotForgetAResultRefusesTheNextTouchAndIsMetAnew) {
  for (const int nth : {1, 17}) {
    meet({Fault::kDrop, MessageType::kResultAcknowledge, {"touch_rejected"}, Reached::kCaptured},
         static_cast<std::uint32_t>(nth), nth - 1);
  }
}

TEST(LinkFaults, TheWayHomeMayFailTooAndEveryTouchIsKept) {
  for (const MessageType on : {MessageType::kTravel, MessageType::kMoveResult}) {
    for (const auto& [fault, expected] :
         {std::pair{Fault::kCloseSocket, "link_lost"}, std::pair{Fault::kGarbage, "protocol_error"},
          std::pair{Fault::kWrongSequence, "protocol_error"}}) {
      meet({fault, on, {expected}, Reached::kNotMade}, 1, kShortTouchCount);
    }
  }
}

TEST(LinkFaults, ACablePulledInASearchLeavesTheStylusAtTheFaceAndTheResumedRunTakesItBackFirst) {
  LoopbackCell loop;
  // Twenty times as fast as an arm: a search takes several of the 20 ms between two reports of the state.
  loop.serve({}, 20.0);
  bool pulled = false;
  std::vector<MessageType> asked;
  Relay* cable = nullptr;
  Relay relay(loop.io(), loop.port(), [&](const cs8::Message& message) {
    const auto* state = std::get_if<cs8::State>(&message.payload);
    if (state && state->phase == cs8::Phase::kSearch && !pulled) {
      pulled = true;
      cable->pull();
    }
    const MessageType type = cs8::type_of(message);
    if (type == MessageType::kTouch || type == MessageType::kRetract) asked.push_back(type);
  });
  cable = &relay;
  loop.launch(relay.port());
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until(State::kHeld);
  EXPECT_EQ(loop.fault_name(), "link_lost");
  expect_touches_once(loop, id, 0);

  asked.clear();
  loop.command(Command::kResume);
  loop.run_until_touches(2);
  expect_touches_once(loop, id, 2);
  ASSERT_GE(asked.size(), 3U);
  EXPECT_EQ(asked[0], MessageType::kRetract);
  EXPECT_EQ(asked[1], MessageType::kTouch);
  EXPECT_EQ(asked[2], MessageType::kTouch);
}

TEST(LinkFaults, ALinkThatIsLostBeforeThereIsAPlanHoldsTheRunWhichIsPlannedOnceItGoesOn) {
  LoopbackCell loop;
  loop.serve();
  loop.launch();
  loop.run_until(State::kIdle);
  const std::int64_t id = loop.start();
  loop.run_until([&](const cell::Status&) { return loop.operation().is_planning(); });
  loop.inject(R"({"fault":"close"})");
  loop.run_until(State::kHeld);
  EXPECT_EQ(loop.fault_name(), "link_lost");
  loop.command(Command::kResume);
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  expect_touches_once(loop, id, kShortTouchCount);
}

TEST(LinkFaults, ARunOnHoldForAnotherReasonKeepsItWhileTheLinkComesAndGoes) {
  LoopbackCell loop;
  loop.serve();
  loop.launch();
  loop.run_until(State::kIdle);
  loop.inject(R"({"fault":"probe_stuck","touch":5})");
  const std::int64_t id = loop.start();
  loop.run_until_over();
  loop.inject(R"({"fault":"close"})");
  loop.run_until([](const cell::Status& status) { return !status.controller.connected; });
  loop.run_until([](const cell::Status& status) { return status.controller.connected; });
  EXPECT_EQ(loop.status().state, State::kHeld);
  EXPECT_EQ(loop.fault_name(), "probe_stuck");
  loop.inject(R"({"fault":"probe_mended"})");
  loop.command(Command::kResume);
  loop.run_until_over();
  EXPECT_EQ(loop.status().state, State::kComplete) << loop.fault_name();
  expect_touches_once(loop, id, kShortTouchCount);
}

TEST(LinkFaults, BetweenRunsTheLinkComesBackByItself) {
  LoopbackCell loop;
  loop.serve({{Fault::kGarbage, MessageType::kState, 3}});
  loop.launch();
  loop.run_until([](const cell::Status& status) { return status.state == State::kIdle; });
  loop.run_until(State::kResetting);
  EXPECT_EQ(loop.fault_name(), "protocol_error");
  loop.run_until(State::kIdle);
  EXPECT_TRUE(loop.fault_name().empty());
}

}  // namespace
}  // namespace touchcal::testing
