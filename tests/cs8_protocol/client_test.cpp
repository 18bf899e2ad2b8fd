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

/// Expects a `T` in a variant and gives it, or a default one.
template <class T, class Variant>
T expect_held(const Variant& variant) {
  if (const auto* held = std::get_if<T>(&variant)) return *held;
  std::string instead = "alternative " + std::to_string(variant.index());
  if (const auto* error = std::get_if<LinkError>(&variant)) instead = error->text;
  ADD_FAILURE() << "holds " << instead;
  return T{};
}

class ClientTest : public WithFakeController {
 protected:
  asio::awaitable<void> connect(Client& client) {
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    expect_held<Welcome>(reply);
  }

  /// The link error of a handshake in which the controller answers Hello with `answer`.
  LinkError refused_handshake(const std::vector<std::uint8_t>& answer) {
    Client client = make_client();
    LinkError error;
    controller_does({[&](Peer& peer) -> asio::awaitable<void> {
      co_await peer.receive<Hello>();
      peer.send_bytes(answer);
      co_await peer.until_closed();
    }});
    run([&]() -> asio::awaitable<void> {
      const ConnectReply reply = co_await client.connect(endpoint(), expected());
      error = expect_held<LinkError>(reply);
      EXPECT_FALSE(client.connected());
    });
    EXPECT_TRUE(losses_.empty()) << "what was never there is not lost";
    return error;
  }
};

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

TEST_F(ClientTest, AnotherArmIsRefusedByName) {
  Welcome other = welcome();
  other.arm = text16("tx60");
  const LinkError error = refused_handshake(encode({0, other}));
  EXPECT_EQ(error.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(error.text, HasSubstr("'tx60', not 'tx90'"));
}

TEST_F(ClientTest, AnotherApplicationIsRefusedByName) {
  Welcome other = welcome();
  other.application = text16("palletizer");
  const LinkError error = refused_handshake(encode({0, other}));
  EXPECT_EQ(error.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(error.text, HasSubstr("'palletizer', not 'touchcal'"));
}

TEST_F(ClientTest, OtherJointRangesAreRefusedWithTheJoint) {
  Welcome other = welcome();
  other.upper_limits[4] += kJointLimitToleranceMicrodeg + 1;
  const LinkError error = refused_handshake(encode({0, other}));
  EXPECT_EQ(error.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(error.text, HasSubstr("joint 5"));
}

TEST_F(ClientTest, JointRangesThatDifferByRoundingAreTaken) {
  Client client = make_client();
  Welcome rounded = welcome();
  rounded.lower_limits[0] -= kJointLimitToleranceMicrodeg;
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(rounded);
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await connect(client);
    client.close();
  });
}

TEST_F(ClientTest, AnotherProtocolVersionIsRefusedWhetherItShowsInTheFrameOrIsTold) {
  auto frame = encode({0, welcome()});
  frame[2] = kProtocolVersion + 1;
  const LinkError shown = refused_handshake(frame);
  EXPECT_EQ(shown.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(shown.text, HasSubstr("version " + std::to_string(kProtocolVersion + 1)));
}

TEST_F(ClientTest, AVersionFaultIsIncompatible) {
  const LinkError told = refused_handshake(encode({0, Fault{FaultCode::kVersion, 2}}));
  EXPECT_EQ(told.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(told.text, HasSubstr("version (detail 2)"));
}

TEST_F(ClientTest, AnOccupiedControllerIsAFaultByName) {
  const LinkError error = refused_handshake(encode({0, Fault{FaultCode::kOccupied, 0}}));
  EXPECT_EQ(error.kind, LinkErrorKind::kOccupied);
  EXPECT_THAT(error.text, HasSubstr("occupied"));
}

TEST_F(ClientTest, NonsenseInTheHandshakeIsAProtocolError) {
  const std::string text = "HTTP/1.1 400 Bad Request\r\n\r\n";
  EXPECT_EQ(refused_handshake({text.begin(), text.end()}).kind, LinkErrorKind::kProtocol);
}

TEST_F(ClientTest, AStateBeforeTheWelcomeIsAProtocolError) {
  EXPECT_EQ(refused_handshake(encode({1, State{.session = 3}})).kind, LinkErrorKind::kProtocol);
}

TEST_F(ClientTest, SilenceInTheHandshakeEndsAtItsDeadline) {
  ClientOptions options = patient();
  options.connect_deadline = milliseconds(50);
  Client client = make_client(options);
  controller_does({[&](Peer& peer) -> asio::awaitable<void> { co_await peer.until_closed(); }});
  run([&]() -> asio::awaitable<void> {
    const auto start = std::chrono::steady_clock::now();
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    EXPECT_EQ(expect_held<LinkError>(reply).kind, LinkErrorKind::kHandshakeTimeout);
    EXPECT_GE(std::chrono::steady_clock::now() - start, options.connect_deadline);
  });
}

TEST_F(ClientTest, NobodyAtTheEndpointIsUnreachable) {
  Client client = make_client();
  tcp::acceptor bound(io_);  // holds the port but does not listen
  bound.open(tcp::v4());
  bound.bind(tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  const tcp::endpoint nobody = bound.local_endpoint();
  run([&]() -> asio::awaitable<void> {
    const ConnectReply reply = co_await client.connect(nobody, expected());
    EXPECT_EQ(expect_held<LinkError>(reply).kind, LinkErrorKind::kUnreachable);
  });
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
