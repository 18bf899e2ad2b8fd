// How a handshake is refused, and why.
#include <gmock/gmock.h>

#include "cs8_protocol/client.hpp"
#include "tests/cs8_protocol/fake_controller.hpp"
#include "tests/cs8_protocol/samples.hpp"

namespace cs8 {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

class ClientHandshakeTest : public WithFakeController {
 protected:
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

TEST_F(ClientHandshakeTest, AnotherArmIsRefusedByName) {
  Welcome other = welcome();
  other.arm = text16("tx60");
  const LinkError error = refused_handshake(encode({0, other}));
  EXPECT_EQ(error.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(error.text, HasSubstr("'tx60', not 'tx90'"));
}

TEST_F(ClientHandshakeTest, AnotherApplicationIsRefusedByName) {
  Welcome other = welcome();
  other.application = text16("palletizer");
  const LinkError error = refused_handshake(encode({0, other}));
  EXPECT_EQ(error.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(error.text, HasSubstr("'palletizer', not 'touchcal'"));
}

TEST_F(ClientHandshakeTest, OtherJointRangesAreRefusedWithTheJoint) {
  Welcome other = welcome();
  other.upper_limits[4] += kJointLimitToleranceMicrodeg + 1;
  const LinkError error = refused_handshake(encode({0, other}));
  EXPECT_EQ(error.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(error.text, HasSubstr("joint 5"));
}

TEST_F(ClientHandshakeTest, JointRangesThatDifferByRoundingAreTaken) {
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

TEST_F(ClientHandshakeTest, AnotherProtocolVersionIsRefusedWhetherItShowsInTheFrameOrIsTold) {
  auto frame = encode({0, welcome()});
  frame[2] = kProtocolVersion + 1;
  const LinkError shown = refused_handshake(frame);
  EXPECT_EQ(shown.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(shown.text, HasSubstr("version " + std::to_string(kProtocolVersion + 1)));
}

TEST_F(ClientHandshakeTest, AVersionFaultIsIncompatible) {
  const LinkError told = refused_handshake(encode({0, Fault{FaultCode::kVersion, 2}}));
  EXPECT_EQ(told.kind, LinkErrorKind::kIncompatible);
  EXPECT_THAT(told.text, HasSubstr("version (detail 2)"));
}

TEST_F(ClientHandshakeTest, AnOccupiedControllerIsAFaultByName) {
  const LinkError error = refused_handshake(encode({0, Fault{FaultCode::kOccupied, 0}}));
  EXPECT_EQ(error.kind, LinkErrorKind::kOccupied);
  EXPECT_THAT(error.text, HasSubstr("occupied"));
}

// As a VAL3 socket that serves one client may treat a second one: it has no words for it.
TEST_F(ClientHandshakeTest, AConnectionThatEndsBeforeTheWelcomeNamesAnotherHostAsTheLikelyCause) {
  Client client = make_client();
  controller_does({[&](Peer& peer) -> asio::awaitable<void> { co_await peer.receive<Hello>(); }});
  run([&]() -> asio::awaitable<void> {
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    const LinkError error = expect_held<LinkError>(reply);
    EXPECT_EQ(error.kind, LinkErrorKind::kPeerClosed);
    EXPECT_THAT(error.text, HasSubstr("another host is connected"));
  });
}

TEST_F(ClientHandshakeTest, NonsenseInTheHandshakeIsAProtocolError) {
  const std::string text = "HTTP/1.1 400 Bad Request\r\n\r\n";
  EXPECT_EQ(refused_handshake({text.begin(), text.end()}).kind, LinkErrorKind::kProtocol);
}

TEST_F(ClientHandshakeTest, AStateBeforeTheWelcomeIsAProtocolError) {
  EXPECT_EQ(refused_handshake(encode({1, State{.session = 3}})).kind, LinkErrorKind::kProtocol);
}

TEST_F(ClientHandshakeTest, SilenceInTheHandshakeEndsAtItsDeadline) {
  ClientOptions options = patient();
  options.connect_deadline = milliseconds(50);
  Client client = make_client(options);
  controller_does({[&](Peer& peer) -> asio::awaitable<void> { co_await peer.until_closed(); }});
  run([&]() -> asio::awaitable<void> {
    const auto start = std::chrono::steady_clock::now();
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    const LinkError error = expect_held<LinkError>(reply);
    EXPECT_EQ(error.kind, LinkErrorKind::kHandshakeTimeout);
    EXPECT_THAT(error.text, HasSubstr("another host is connected"));
    EXPECT_GE(std::chrono::steady_clock::now() - start, options.connect_deadline);
  });
}

TEST_F(ClientHandshakeTest, NobodyAtTheEndpointIsUnreachable) {
  Client client = make_client();
  tcp::acceptor bound(io_);  // holds the port but does not listen
  bound.open(tcp::v4());
  bound.bind(tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  const tcp::endpoint nobody = bound.local_endpoint();
  run([&]() -> asio::awaitable<void> {
    const ConnectReply reply = co_await client.connect(nobody, expected());
    const LinkError error = expect_held<LinkError>(reply);
    EXPECT_EQ(error.kind, LinkErrorKind::kUnreachable);
    EXPECT_THAT(error.text, ::testing::Not(HasSubstr("another host")));
  });
}

}  // namespace
}  // namespace cs8
