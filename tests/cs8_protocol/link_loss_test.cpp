#include <gmock/gmock.h>

#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <limits>
#include <utility>

#include "tests/cs8_protocol/fake_controller.hpp"

/// However a link ends while a touch runs: the touch ends with the reason, the owner is told once, nothing
/// stays.
namespace cs8 {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

class LinkLoss : public WithFakeController {
 protected:
  static Touch some_touch() { return {.deadline_ms = 5000}; }

  /// The error a touch ends with when the controller, after the handshake, does `script`. The script begins
  /// when the touch has been received.
  LinkError touch_while(const Script& script, ClientOptions options = patient()) {
    Client client = make_client(options);
    LinkError error;
    controller_does({[&](Peer& peer) -> asio::awaitable<void> {
      co_await peer.shake_hands(welcome());
      co_await peer.receive<Touch>();
      co_await script(peer);
    }});
    run([&]() -> asio::awaitable<void> {
      const ConnectReply connected = co_await client.connect(endpoint(), expected());
      EXPECT_TRUE(std::holds_alternative<Welcome>(connected));
      const TouchReply reply = co_await client.touch(some_touch());
      EXPECT_EQ(losses_.size(), 1u) << "the loss is told before the call ends";
      EXPECT_EQ(reply.sequence, 1u);
      if (const auto* ended = std::get_if<LinkError>(&reply.answer)) {
        error = *ended;
      } else {
        ADD_FAILURE() << "the touch was answered";
      }
      EXPECT_FALSE(client.connected());
    });
    EXPECT_EQ(losses_.size(), 1u);
    for (const LinkError& loss : std::exchange(losses_, {})) EXPECT_EQ(loss.text, error.text);
    return error;
  }

  /// As above, for a controller that sends this and then waits for the end.
  LinkError touch_answered_by(std::uint32_t sequence, const Payload& answer) {
    return touch_while([&](Peer& peer) -> asio::awaitable<void> {
      peer.send(sequence, answer);
      co_await peer.until_closed();
    });
  }
};

TEST_F(LinkLoss, AConnectionClosedDuringATouchEndsIt) {
  const LinkError error = touch_while([](Peer& peer) -> asio::awaitable<void> {
    peer.send(1, Accepted{});
    co_return;
  });
  EXPECT_EQ(error.kind, LinkErrorKind::kPeerClosed);
}

TEST_F(LinkLoss, AFrameThatIsCutOffEndsTheTouch) {
  const LinkError error = touch_while([](Peer& peer) -> asio::awaitable<void> {
    auto frame = encode({1, TouchResult{.outcome = Outcome::kContact}});
    frame.pop_back();
    peer.send_bytes(frame);
    co_return;
  });
  EXPECT_EQ(error.kind, LinkErrorKind::kPeerClosed);
}

TEST_F(LinkLoss, SilenceDuringATouchEndsItAtTheHeartbeatTimeout) {
  ClientOptions options = patient();
  options.heartbeat_timeout = milliseconds(60);
  std::chrono::steady_clock::time_point last_word;
  const LinkError error = touch_while(
      [&](Peer& peer) -> asio::awaitable<void> {
        peer.send(1, Accepted{});
        last_word = std::chrono::steady_clock::now();
        co_await peer.until_closed();
      },
      options);
  EXPECT_EQ(error.kind, LinkErrorKind::kSilent);
  const auto waited = std::chrono::steady_clock::now() - last_word;
  EXPECT_GE(waited, options.heartbeat_timeout);
  EXPECT_LT(waited, std::chrono::seconds(5)) << "long before any other deadline of this test";
}

TEST_F(LinkLoss, HalfAFrameAndThenSilenceIsSilence) {
  ClientOptions options = patient();
  options.heartbeat_timeout = milliseconds(60);
  const LinkError error = touch_while(
      [&](Peer& peer) -> asio::awaitable<void> {
        peer.send_bytes({'T', 'C', 1});
        co_await peer.until_closed();
      },
      options);
  EXPECT_EQ(error.kind, LinkErrorKind::kSilent);
}

TEST_F(LinkLoss, ACommandThatIsNeverAcceptedEndsAtTheAnswerDeadline) {
  ClientOptions options = patient();
  options.answer_deadline = milliseconds(50);
  const LinkError error =
      touch_while([](Peer& peer) -> asio::awaitable<void> { co_await peer.until_closed(); }, options);
  EXPECT_EQ(error.kind, LinkErrorKind::kUnanswered);
  EXPECT_THAT(error.text, HasSubstr("command 1 was not answered"));
}

TEST_F(LinkLoss, AnAcceptedCommandWithoutAResultEndsAtItsOwnDeadline) {
  ClientOptions options = patient();
  options.result_margin = milliseconds(20);
  Client client = make_client(options);
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, Accepted{});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    const auto start = std::chrono::steady_clock::now();
    const Touch brief{.deadline_ms = 30};
    const TouchReply reply = co_await client.touch(brief);
    EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(50));
    const auto* error = std::get_if<LinkError>(&reply.answer);
    EXPECT_TRUE(error != nullptr && error->kind == LinkErrorKind::kUnanswered);
  });
}

/// A controller that accepts a touch, sends no result, and tells that nothing runs.
Script loses_result(const Welcome& welcome, const std::optional<Payload>& answer) {
  return [welcome, answer](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome);
    co_await peer.receive<Touch>();
    peer.send(1, Accepted{});
    peer.send(0, State{.session = welcome.session});
    const ResultQuery question = co_await peer.receive<ResultQuery>();
    EXPECT_EQ(question.command_sequence, 1u);
    if (answer) peer.send(1, *answer);
    co_await peer.until_closed();
  };
}

ClientOptions asks_at_once() {
  ClientOptions options;
  options.heartbeat_timeout = std::chrono::seconds(10);
  options.answer_deadline = milliseconds(200);
  options.result_lost_after = milliseconds(0);
  return options;
}

TEST_F(LinkLoss, AResultThatIsLostIsAskedForOnceNothingRuns) {
  Client client = make_client(asks_at_once());
  controller_does({loses_result(welcome(), TouchResult{.outcome = Outcome::kContact})});
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    const TouchReply reply = co_await client.touch(some_touch());
    const auto* result = std::get_if<TouchResult>(&reply.answer);
    EXPECT_TRUE(result != nullptr && result->outcome == Outcome::kContact);
    EXPECT_TRUE(client.connected());
    client.close();
  });
  EXPECT_TRUE(losses_.empty());
}

TEST_F(LinkLoss, AResultThatTheControllerDoesNotHaveEitherEndsTheTouchLongBeforeItsDeadline) {
  for (const auto& answer : {std::optional<Payload>(ResultUnknown{1}), std::optional<Payload>()}) {
    losses_.clear();
    Client client = make_client(asks_at_once());
    controller_does({loses_result(welcome(), answer)});
    run([&]() -> asio::awaitable<void> {
      co_await client.connect(endpoint(), expected());
      const TouchReply reply = co_await client.touch(some_touch());
      const auto* error = std::get_if<LinkError>(&reply.answer);
      EXPECT_TRUE(error != nullptr && error->kind == LinkErrorKind::kUnanswered);
    });
    EXPECT_EQ(losses_.size(), 1u);
  }
}

TEST_F(LinkLoss, AStopThatEndsNothingIsNotWaitedForUntilTheCommandsDeadline) {
  ClientOptions options = patient();
  options.answer_deadline = milliseconds(100);
  Client client = make_client(options);
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, Accepted{});
    peer.send(0, State{.session = welcome().session, .active_sequence = 1});
    co_await peer.receive<Stop>();
    co_await peer.until_closed();
  }});
  on_state_ = [&](const State&) { client.stop(); };
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    const auto start = std::chrono::steady_clock::now();
    const TouchReply reply = co_await client.touch(Touch{.deadline_ms = 15'000});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
    const auto* error = std::get_if<LinkError>(&reply.answer);
    EXPECT_TRUE(error != nullptr && error->kind == LinkErrorKind::kUnanswered);
  });
}

TEST_F(LinkLoss, WithoutANumberLeftForACommandTheLinkEndsAndNothingIsSent) {
  Client client = make_client();
  Welcome used_up = welcome();
  used_up.last_sequence = std::numeric_limits<std::uint32_t>::max();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(used_up);
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    const TouchReply reply = co_await client.touch(some_touch());
    const auto* error = std::get_if<LinkError>(&reply.answer);
    EXPECT_EQ(reply.sequence, 0u);
    EXPECT_THAT(error ? error->text : std::string(), HasSubstr("no number left"));
  });
}

TEST_F(LinkLoss, BytesThatAreNoFrameEndTheTouch) {
  const LinkError error = touch_while([](Peer& peer) -> asio::awaitable<void> {
    peer.send_bytes(std::vector<std::uint8_t>(64, 0xa5));
    co_await peer.until_closed();
  });
  EXPECT_EQ(error.kind, LinkErrorKind::kProtocol);
}

TEST_F(LinkLoss, AnAnswerToAnotherSequenceEndsTheLinkInsteadOfShiftingTheSeries) {
  for (const std::uint32_t sequence : {0u, 2u}) {
    for (const Payload& answer :
         {Payload(Accepted{}), Payload(Rejected{RejectReason::kBusy, 0}), Payload(ResultUnknown{sequence}),
          Payload(TouchResult{.outcome = Outcome::kContact}),
          Payload(MoveResult{.outcome = Outcome::kArrived})}) {
      const LinkError error = touch_answered_by(sequence, answer);
      EXPECT_EQ(error.kind, LinkErrorKind::kProtocol);
      EXPECT_THAT(error.text, HasSubstr("with sequence " + std::to_string(sequence)));
    }
  }
}

TEST_F(LinkLoss, AnAnswerOfAnotherKindEndsTheLink) {
  EXPECT_EQ(touch_answered_by(1, MoveResult{.outcome = Outcome::kArrived}).kind, LinkErrorKind::kProtocol);
  EXPECT_EQ(touch_answered_by(1, ResultUnknown{1}).kind, LinkErrorKind::kProtocol);
  EXPECT_EQ(touch_answered_by(0, Welcome{}).kind, LinkErrorKind::kProtocol);
  EXPECT_EQ(touch_answered_by(0, Heartbeat{1}).kind, LinkErrorKind::kProtocol);
}

TEST_F(LinkLoss, AChangeOfSessionWithinAConnectionEndsIt) {
  const LinkError error = touch_answered_by(1, State{.session = 4});
  EXPECT_EQ(error.kind, LinkErrorKind::kProtocol);
  EXPECT_THAT(error.text, HasSubstr("session changed from 3 to 4"));
}

TEST_F(LinkLoss, AFaultOfTheControllerIsNamed) {
  const LinkError error = touch_answered_by(0, Fault{FaultCode::kBadValue, 1});
  EXPECT_EQ(error.kind, LinkErrorKind::kFault);
  EXPECT_THAT(error.text, HasSubstr("bad_value (detail 1)"));
}

TEST_F(LinkLoss, AControllerThatStopsReadingIsFoundOut) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    asio::steady_timer never(io_, std::chrono::hours(1));
    co_await never.async_wait(asio::use_awaitable);
  }});
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    for (int i = 0; i < 10'000'000 && client.connected(); ++i) {
      client.stop();
      if (i % 1'000 == 0) co_await asio::post(io_, asio::use_awaitable);
    }
    EXPECT_FALSE(client.connected());
    io_.stop();
  });
  io_.restart();
  io_.poll();
  ASSERT_EQ(losses_.size(), 1u);
  EXPECT_EQ(losses_.front().kind, LinkErrorKind::kSilent);
}

/// The moment at which an owner connects anew is any: here as soon as it can see that there is no link.
TEST_F(LinkLoss, IsToldBeforeTheOwnerCanConnectAnew) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
                     co_await peer.shake_hands(welcome());
                     peer.send_bytes({'n', 'o', ' ', 'f', 'r', 'a', 'm', 'e', '.', '.', '.', '.'});
                     co_await peer.until_closed();
                   },
                   [&](Peer& peer) -> asio::awaitable<void> {
                     co_await peer.shake_hands(welcome());
                     co_await peer.until_closed();
                   }});
  run([&]() -> asio::awaitable<void> {
    const ConnectReply first = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(first));
    while (client.connected()) co_await asio::post(io_, asio::use_awaitable);
    const ConnectReply second = co_await client.connect(endpoint(), expected());
    EXPECT_TRUE(std::holds_alternative<Welcome>(second));
    client.close();
  });
  ASSERT_EQ(losses_.size(), 1u);
  EXPECT_EQ(losses_[0].kind, LinkErrorKind::kProtocol);
}

}  // namespace
}  // namespace cs8
