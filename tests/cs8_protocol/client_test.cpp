#include "cs8_protocol/client.hpp"

#include <gmock/gmock.h>

#include "tests/cs8_protocol/fake_controller.hpp"
#include "tests/cs8_protocol/samples.hpp"

namespace cs8 {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr std::uint32_t kDeadlineMs = 5000;

Touch some_touch() { return {.via_count = 1, .search_speed_um_s = 8000, .deadline_ms = kDeadlineMs}; }

class ClientTest : public WithFakeController {};

TEST_F(ClientTest, TheHandshakeGivesTheWelcomeAndTheNextSequence) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    const Hello hello = co_await peer.receive<Hello>();
    EXPECT_EQ(hello.heartbeat_timeout_ms, 10000u);
    Welcome answer = welcome();
    answer.last_sequence = 41;
    peer.send(0, answer);
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    EXPECT_EQ(expect_held<Welcome>(reply).session, 3u);
    EXPECT_TRUE(client.connected());
    EXPECT_EQ(client.next_sequence(), 42u);
    client.close();
    EXPECT_FALSE(client.connected());
    EXPECT_EQ(client.next_sequence(), 0u);
  });
  EXPECT_TRUE(losses_.empty());
}

TEST_F(ClientTest, ATouchIsAnsweredByItsResult) {
  Client client = make_client();
  const TouchResult result{.outcome = Outcome::kContact,
                           .phase = Phase::kRetract,
                           .source = CaptureSource::kLatched,
                           .contact = joints_from(5)};
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    const Touch command = co_await peer.receive<Touch>();
    EXPECT_EQ(peer.sequence(), 1u);
    EXPECT_EQ(command.search_speed_um_s, some_touch().search_speed_um_s);
    peer.send(1, Accepted{});
    peer.send(1, result);
    const ResultAcknowledge acknowledged = co_await peer.receive<ResultAcknowledge>();
    EXPECT_EQ(acknowledged.command_sequence, 1u);
    co_await peer.receive<Travel>();
    EXPECT_EQ(peer.sequence(), 2u);
    peer.send(2, MoveResult{.outcome = Outcome::kArrived, .phase = Phase::kIdle, .joints = joints_from(6)});
    co_await peer.receive<Retract>();
    peer.send(3, MoveResult{.outcome = Outcome::kStopped, .phase = Phase::kRetract});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    const TouchReply touched = co_await client.touch(some_touch());
    EXPECT_EQ(touched.sequence, 1u);
    EXPECT_EQ(expect_held<TouchResult>(touched.answer).contact, result.contact);
    client.acknowledge(touched.sequence);
    const MoveReply travelled = co_await client.travel({.deadline_ms = kDeadlineMs});
    EXPECT_EQ(expect_held<MoveResult>(travelled.answer).joints, joints_from(6));
    const MoveReply retracted = co_await client.retract({.deadline_ms = kDeadlineMs});
    EXPECT_EQ(expect_held<MoveResult>(retracted.answer).outcome, Outcome::kStopped);
    client.close();
  });
  EXPECT_TRUE(losses_.empty());
}

TEST_F(ClientTest, ARejectedTouchSaysWhyAndTheNextOneHasANewSequence) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, Rejected{RejectReason::kOutOfRange, 5});
    co_await peer.receive<Touch>();
    EXPECT_EQ(peer.sequence(), 2u);
    peer.send(2, Rejected{RejectReason::kHold, 0});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    const TouchReply first = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<Rejected>(first.answer).reason, RejectReason::kOutOfRange);
    EXPECT_EQ(expect_held<Rejected>(first.answer).detail, 5);
    const TouchReply second = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<Rejected>(second.answer).reason, RejectReason::kHold);
    client.close();
  });
}

TEST_F(ClientTest, StopIsSentWhileATouchRuns) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, Accepted{});
    peer.send(1, State{.session = 3, .active_sequence = 1, .phase = Phase::kSearch});
    co_await peer.receive<Stop>();
    peer.send(1, TouchResult{.outcome = Outcome::kStopped, .phase = Phase::kSearch});
    co_await peer.until_closed();
  }});
  on_state_ = [&](const State& state) {
    if (state.active_sequence == 1) client.stop();
  };
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    const TouchReply reply = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<TouchResult>(reply.answer).outcome, Outcome::kStopped);
    client.close();
  });
}

TEST_F(ClientTest, TheLatestStateIsKeptAndGivenToTheHook) {
  Client client = make_client();
  std::vector<std::uint32_t> clocks;
  on_state_ = [&](const State& state) {
    clocks.push_back(state.clock_ms);
    if (clocks.size() == 2) client.close();
  };
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    for (const std::uint32_t clock : {20u, 40u, 60u})
      peer.send(clock, State{.session = 3, .clock_ms = clock});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    EXPECT_FALSE(client.latest_state());
    EXPECT_FALSE(client.heard_at());
    co_await connect(client);
  });
  EXPECT_EQ(clocks, (std::vector<std::uint32_t>{20, 40})) << "nothing is called back after close()";
  ASSERT_TRUE(client.latest_state());
  EXPECT_EQ(client.latest_state()->clock_ms, 40u);
  EXPECT_TRUE(client.heard_at());
}

TEST_F(ClientTest, HeartbeatsAreSentWithARisingClock) {
  ClientOptions options = patient();
  options.heartbeat_period = milliseconds(5);
  Client client = make_client(options);
  std::vector<std::uint32_t> clocks;
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    for (int i = 0; i < 4; ++i) {
      const Heartbeat beat = co_await peer.receive<Heartbeat>();
      clocks.push_back(beat.host_clock_ms);
    }
  }});
  run([&]() -> asio::awaitable<void> { co_await connect(client); });
  ASSERT_EQ(clocks.size(), 4u);
  for (std::size_t i = 1; i < clocks.size(); ++i) EXPECT_GE(clocks[i], clocks[i - 1] + 5);
}

TEST_F(ClientTest, AStateIsAnsweredWithAHeartbeat) {
  ClientOptions options = patient();
  options.heartbeat_period = std::chrono::hours(1);
  Client client = make_client(options);
  int beats = 0;
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Heartbeat>();  // the first one, unasked
    for (; beats < 3; ++beats) {
      peer.send(0, State{.session = 3});
      co_await peer.receive<Heartbeat>();
    }
  }});
  run([&]() -> asio::awaitable<void> { co_await connect(client); });
  EXPECT_EQ(beats, 3);
}

TEST_F(ClientTest, AfterABreakTheNextConnectionTellsWhatBecameOfTheOpenTouch) {
  Client client = make_client();
  const TouchResult result{.outcome = Outcome::kHeartbeatLost, .phase = Phase::kSearch};
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
                     co_await peer.shake_hands(welcome());
                     co_await peer.receive<Touch>();
                     peer.send(1, Accepted{});
                   },
                   [&](Peer& peer) -> asio::awaitable<void> {
                     Welcome again = welcome();
                     again.last_sequence = again.open_sequence = 1;
                     co_await peer.shake_hands(again);
                     const ResultQuery question = co_await peer.receive<ResultQuery>();
                     EXPECT_EQ(question.command_sequence, 1u);
                     peer.send(1, Accepted{});
                     peer.send(1, result);
                     co_await peer.receive<ResultAcknowledge>();
                     co_await peer.receive<ResultQuery>();
                     peer.send(1, ResultUnknown{1});
                     co_await peer.until_closed();
                   }});
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    const TouchReply lost = co_await client.touch(some_touch());
    EXPECT_EQ(lost.sequence, 1u);
    EXPECT_EQ(expect_held<LinkError>(lost.answer).kind, LinkErrorKind::kPeerClosed);
    co_await connect(client);
    EXPECT_EQ(client.next_sequence(), 2u);
    const QueryReply found = co_await client.query(lost.sequence, milliseconds(kDeadlineMs));
    EXPECT_EQ(expect_held<TouchResult>(found).outcome, Outcome::kHeartbeatLost);
    client.acknowledge(lost.sequence);
    const QueryReply forgotten = co_await client.query(lost.sequence, milliseconds(kDeadlineMs));
    EXPECT_EQ(expect_held<ResultUnknown>(forgotten).command_sequence, 1u);
    client.close();
  });
  EXPECT_EQ(losses_.size(), 1u);
}

TEST_F(ClientTest, AResultThatComesTwiceIsTakenOnce) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    Welcome open = welcome();
    open.last_sequence = open.open_sequence = 6;
    co_await peer.shake_hands(open);
    peer.send(
        6, MoveResult{.outcome = Outcome::kHeartbeatLost, .phase = Phase::kTravel});  // unasked: it was open
    co_await peer.receive<Touch>();
    const TouchResult result{.outcome = Outcome::kNoContact, .phase = Phase::kRetract};
    peer.send(7, result);
    peer.send(7, result);
    co_await peer.receive<Touch>();
    peer.send(7, result);
    peer.send(8, TouchResult{.outcome = Outcome::kContact, .phase = Phase::kRetract});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    const TouchReply first = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<TouchResult>(first.answer).outcome, Outcome::kNoContact);
    const TouchReply second = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<TouchResult>(second.answer).outcome, Outcome::kContact);
    client.close();
  });
  EXPECT_TRUE(losses_.empty());
}

TEST_F(ClientTest, ACallWithoutAConnectionSaysSo) {
  Client client = make_client();
  run([&]() -> asio::awaitable<void> {
    client.stop();
    client.acknowledge(1);
    const TouchReply reply = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<LinkError>(reply.answer).kind, LinkErrorKind::kNotConnected);
    EXPECT_EQ(reply.sequence, 0u);
    const QueryReply found = co_await client.query(1, milliseconds(kDeadlineMs));
    EXPECT_EQ(expect_held<LinkError>(found).kind, LinkErrorKind::kNotConnected);
  });
}

TEST_F(ClientTest, ASecondCallWhileOneWaitsIsOurOwnMistake) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, State{.session = 3, .active_sequence = 1});
    co_await peer.until_closed();
  }});
  bool thrown = false;
  on_state_ = [&](const State&) {
    asio::co_spawn(io_, client.travel({.deadline_ms = kDeadlineMs}),
                   [&](const std::exception_ptr& failure, auto&&) {
                     try {
                       if (failure) std::rethrow_exception(failure);
                     } catch (const std::logic_error&) {
                       thrown = true;
                     }
                     client.close();
                   });
  };
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    const TouchReply reply = co_await client.touch(some_touch());
    EXPECT_EQ(expect_held<LinkError>(reply.answer).kind, LinkErrorKind::kClosed);
  });
  EXPECT_TRUE(thrown);
}

}  // namespace
}  // namespace cs8
