#include <gmock/gmock.h>

#include <boost/asio/bind_cancellation_slot.hpp>
#include <boost/asio/cancellation_signal.hpp>
#include <memory>

#include "tests/cs8_protocol/fake_controller.hpp"

/// The owner ends the link, whatever is under way.
namespace cs8 {
namespace {

using ::testing::HasSubstr;

class ClientEnd : public WithFakeController {
 protected:
  static Touch some_touch() { return {.deadline_ms = 5000}; }
};

TEST_F(ClientEnd, ClosingDuringATouchEndsItAndCallsNothingBack) {
  Client client = make_client();
  on_state_ = [&](const State&) { client.close(); };
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, State{.session = 3});
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    const TouchReply reply = co_await client.touch(some_touch());
    const auto* error = std::get_if<LinkError>(&reply.answer);
    EXPECT_TRUE(error != nullptr && error->kind == LinkErrorKind::kClosed);
  });
  EXPECT_TRUE(losses_.empty());
}

TEST_F(ClientEnd, ClosingDuringTheHandshakeEndsIt) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.receive<Hello>();
    client.close();
    co_await peer.until_closed();
  }});
  run([&]() -> asio::awaitable<void> {
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    const auto* error = std::get_if<LinkError>(&reply);
    EXPECT_TRUE(error != nullptr && error->kind == LinkErrorKind::kClosed);
  });
}

TEST_F(ClientEnd, TheClientMayBeDestroyedFromItsOwnHooksAndWhileACallWaits) {
  for (const bool on_loss : {false, true}) {
    std::unique_ptr<Client> client;
    const auto destroy = [&] { client.reset(); };
    client = std::make_unique<Client>(io_.get_executor(), patient(),
                                      ClientHooks{.on_state =
                                                      [&, on_loss](const State&) {
                                                        if (!on_loss) destroy();
                                                      },
                                                  .on_loss =
                                                      [&, on_loss](const LinkError&) {
                                                        if (on_loss) destroy();
                                                      }});
    controller_does({[&](Peer& peer) -> asio::awaitable<void> {
      co_await peer.shake_hands(welcome());
      co_await peer.receive<Touch>();
      peer.send(1, State{.session = 3});
      peer.send(0, Fault{FaultCode::kLength, 4});
      co_await peer.until_closed();
    }});
    run([&]() -> asio::awaitable<void> {
      co_await client->connect(endpoint(), expected());
      const TouchReply reply = co_await client->touch(some_touch());
      EXPECT_TRUE(std::holds_alternative<LinkError>(reply.answer));
    });
    EXPECT_EQ(client, nullptr);
  }
}

TEST_F(ClientEnd, ACallThatIsCancelledEndsTheLinkBecauseItsAnswerHasNowhereToGo) {
  Client client = make_client();
  asio::cancellation_signal cancel;
  on_state_ = [&](const State&) { cancel.emit(asio::cancellation_type::terminal); };
  controller_does({[&](Peer& peer) -> asio::awaitable<void> {
    co_await peer.shake_hands(welcome());
    co_await peer.receive<Touch>();
    peer.send(1, State{.session = 3});
    co_await peer.until_closed();
  }});
  bool cancelled = false;
  run([&]() -> asio::awaitable<void> {
    co_await client.connect(endpoint(), expected());
    asio::co_spawn(
        io_, client.touch(some_touch()),
        asio::bind_cancellation_slot(cancel.slot(), [&](const std::exception_ptr& failure, auto&&) {
          cancelled = failure != nullptr;
        }));
  });
  EXPECT_TRUE(cancelled);
  ASSERT_EQ(losses_.size(), 1u);
  EXPECT_THAT(losses_.front().text, HasSubstr("given up"));
}

}  // namespace
}  // namespace cs8
