// Channels of an application over real sockets: the test is the program at one end, and its peer at the
// other.
#include "sim_controller/val3_socket.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/executor_work_guard.hpp>
#include <chrono>
#include <optional>

#include "sim_controller/val3_channels.hpp"
#include "tcp_peer.hpp"

namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using testing::TcpPeer;

/// No test waits longer for loopback; on a loaded machine it is far more than it takes.
constexpr std::chrono::seconds kSocketPatience{60};

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

class Val3SocketTest : public ::testing::Test {
 protected:
  Val3Socket::Tell tell() {
    return [this](const std::string& text) { told_.push_back(text); };
  }
  void open(const RunSocket& at) { socket_ = open_socket(io_, channel_, at, tell()); }
  /// A server that the program has begun to use.
  void serve() {
    open({"host", "", 0});
    channel_.connect();
    look();
  }
  TcpPeer client() { return {io_, socket_->port()}; }

  void look() {
    io_.poll();
    socket_->exchange(now_);
  }
  template <class Condition>
  [[nodiscard]] bool look_until(Condition condition) {
    const auto deadline = std::chrono::steady_clock::now() + kSocketPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      look();
    }
    return true;
  }

  std::string read(std::size_t most = Val3Channel::kBufferedMax) {
    std::vector<std::uint8_t> bytes(most);
    bytes.resize(channel_.receive(bytes));
    return {bytes.begin(), bytes.end()};
  }
  std::size_t send(std::string_view text) { return channel_.send(bytes_of(text)); }

  asio::io_context io_;
  /// Without it the io_context would not go on when no handler is left.
  asio::executor_work_guard<asio::io_context::executor_type> goes_on_ = asio::make_work_guard(io_);
  Val3Channel channel_{"Socket\\host"};
  std::vector<std::string> told_;
  Val3Socket::TimePoint now_{std::chrono::hours(1)};
  std::unique_ptr<Val3Socket> socket_;
};

// ---- servers ----

TEST_F(Val3SocketTest, AServerListensFromTheProgramsFirstUse) {
  open({"host", "", 0});
  look();
  EXPECT_THROW(client(), boost::system::system_error);
  EXPECT_THAT(socket_->summary(), HasSubstr("the application has not used it"));
  channel_.connect();
  look();
  EXPECT_THAT(told_, Contains("Socket\\host: listening on 127.0.0.1:" + std::to_string(socket_->port())));
  TcpPeer peer = client();
  EXPECT_TRUE(look_until([&] { return channel_.connect(); }));
}

TEST_F(Val3SocketTest, AServerIsThereForThisMachineOnly) {
  serve();
  tcp::socket elsewhere(io_);
  // Another address of this machine; one of its network cards is no different.
  EXPECT_THROW(elsewhere.connect({asio::ip::make_address_v4("127.0.0.2"), socket_->port()}),
               boost::system::system_error);
}

TEST_F(Val3SocketTest, BytesGoBothWaysOneByOneToo) {
  serve();
  TcpPeer peer = client();
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  const std::string text = std::string("hello\r\0\xff", 8);
  for (std::size_t i = 0; i < text.size(); ++i) {
    ASSERT_EQ(peer.write(text.substr(i, 1)), 1U);
    ASSERT_TRUE(look_until([&] { return channel_.waiting() == i + 1; }));
  }
  EXPECT_EQ(read(), text);
  send("an ");
  send("answer");
  EXPECT_TRUE(look_until([&] { return peer.received() == "an answer"; }));
  EXPECT_THAT(socket_->summary(), HasSubstr("connections 1, bytes received 8, bytes sent 9"));
}

TEST_F(Val3SocketTest, APeerThatEndsItsSendingGetsTheAnswerAndIsGoneThen) {
  serve();
  TcpPeer peer = client();
  peer.write("how much\r");
  peer.end_sending();
  ASSERT_TRUE(look_until([&] { return channel_.waiting() == 9; }));
  look();
  EXPECT_TRUE(channel_.connect()) << "the program has not read it";
  EXPECT_EQ(read(), "how much\r");
  EXPECT_EQ(send("7\r"), 2U);
  look();
  EXPECT_EQ(channel_.peer(), Val3Channel::Peer::kGone);
  EXPECT_FALSE(peer.has_ended()) << "the program has not closed";
  EXPECT_TRUE(channel_.close());
  EXPECT_TRUE(look_until([&] { return peer.has_ended(); }));
  EXPECT_EQ(peer.received(), "7\r");
}

TEST_F(Val3SocketTest, APeerThatIsLostIsGoneAtOnceAndTheNextOneServed) {
  serve();
  TcpPeer peer = client();
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  peer.reset();
  ASSERT_TRUE(look_until([&] { return channel_.peer() == Val3Channel::Peer::kGone; }));
  EXPECT_THAT(told_, Contains(HasSubstr("the connection is lost")));
  EXPECT_EQ(send("x"), 0U);
  channel_.close();
  TcpPeer next = client();
  EXPECT_TRUE(look_until([&] { return channel_.connect(); }));
  next.write("b");
  EXPECT_TRUE(look_until([&] { return channel_.waiting() == 1; }));
}

TEST_F(Val3SocketTest, ASecondClientIsTurnedAwayAndTheFirstGoesOn) {
  serve();
  TcpPeer first = client();
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  TcpPeer second = client();
  second.write("let me in");
  EXPECT_TRUE(look_until([&] { return second.has_ended(); }));
  TcpPeer third = client();
  EXPECT_TRUE(look_until([&] { return third.has_ended(); }));
  EXPECT_THAT(told_, Contains(HasSubstr("a second client, 127.0.0.1:")).Times(1)) << "a log has bounds";
  first.write("a");
  EXPECT_TRUE(look_until([&] { return channel_.waiting() > 0; }));
  EXPECT_EQ(read(), "a");
}

TEST_F(Val3SocketTest, OneClientWaitsUntilTheProgramHasClosedTheLastConnection) {
  serve();
  TcpPeer first = client();
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  first.close();
  ASSERT_TRUE(look_until([&] { return channel_.peer() == Val3Channel::Peer::kGone; }));
  TcpPeer next = client();
  next.write("next");
  look();
  TcpPeer after_next = client();
  EXPECT_TRUE(look_until([&] { return after_next.has_ended(); }));
  EXPECT_FALSE(next.has_ended());
  EXPECT_EQ(channel_.waiting(), 0U);
  channel_.close();
  EXPECT_TRUE(look_until([&] { return channel_.waiting() == 4; }));
  EXPECT_EQ(read(), "next");
}

TEST_F(Val3SocketTest, WhatTheProgramWroteBeforeItClosedArrives) {
  serve();
  TcpPeer peer = client();
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  peer.write("never read");
  ASSERT_TRUE(look_until([&] { return channel_.waiting() > 0; }));
  send("bye");
  channel_.close();
  ASSERT_TRUE(look_until([&] { return peer.has_ended(); }));
  EXPECT_EQ(peer.received(), "bye");
  EXPECT_TRUE(socket_->is_open()) << "the peer has not closed";
  now_ += Val3Socket::kEndMax;
  look();
  EXPECT_FALSE(socket_->is_open());
}

TEST_F(Val3SocketTest, TheEndOfTheRunSendsWhatIsLeftAndNobodyConnectsAnyMore) {
  serve();
  TcpPeer peer = client();
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  send("bye");
  socket_->end(now_);
  ASSERT_TRUE(look_until([&] { return peer.has_ended(); }));
  EXPECT_EQ(peer.received(), "bye");
  peer.close();
  EXPECT_TRUE(look_until([&] { return !socket_->is_open(); }));
  EXPECT_THROW(client(), boost::system::system_error);
}

TEST_F(Val3SocketTest, BytesThatNobodyReadsAreBoundedBothWaysAndNoneIsLost) {
  serve();
  TcpPeer peer(io_, socket_->port(), 4096);
  ASSERT_TRUE(look_until([&] { return channel_.connect(); }));
  std::string written;
  const auto next_bytes = [](std::size_t from) {
    std::string bytes(1000, '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>((from + i) % 251);
    return bytes;
  };
  while (written.size() < 4 * Val3Channel::kBufferedMax) {
    const std::string bytes = next_bytes(written.size());
    const std::size_t size = peer.write(bytes);
    written += bytes.substr(0, size);
    look();
    ASSERT_LE(channel_.waiting(), Val3Channel::kBufferedMax);
    if (size == 0) break;  // the two TCPs hold the rest
  }
  ASSERT_TRUE(look_until([&] { return channel_.waiting() == Val3Channel::kBufferedMax; }));
  std::string got;
  EXPECT_TRUE(look_until([&] { return (got += read()).size() == written.size(); }));
  EXPECT_TRUE(got == written);

  std::string sent;
  for (std::size_t taken = 1; taken > 0; look()) {
    const std::string bytes = next_bytes(sent.size());
    taken = send(bytes);
    sent += bytes.substr(0, taken);
  }
  EXPECT_TRUE(look_until([&] { return peer.received().size() == sent.size(); }));
  EXPECT_TRUE(peer.received() == sent);
}

TEST_F(Val3SocketTest, APortThatIsTakenIsRefusedWithTheRemedy) {
  serve();
  Val3Channel other("Socket\\other");
  try {
    open_socket(io_, other, {"other", "", socket_->port()}, tell());
    FAIL() << "two servers on one port";
  } catch (const SocketRefusal& refusal) {
    EXPECT_THAT(refusal.what(), AllOf(HasSubstr("Socket\\other: cannot listen on 127.0.0.1:"),
                                      HasSubstr("give another port with --socket, or 0")));
  }
}

TEST_F(Val3SocketTest, APortThatIsTakenBeforeTheProgramUsesItIsRefusedThen) {
  open({"host", "", 0});
  Val3Channel other("Socket\\other");
  const auto late = open_socket(io_, other, {"other", "", socket_->port()}, tell());
  channel_.connect();
  look();
  other.connect();
  EXPECT_THROW(late->exchange(now_), SocketRefusal);
}

// ---- clients ----

class Val3ClientSocketTest : public Val3SocketTest {
 protected:
  Val3ClientSocketTest() {
    acceptor_.bind({asio::ip::address_v4::loopback(), 0});
    acceptor_.non_blocking(true);
    open({"host", "127.0.0.1", acceptor_.local_endpoint().port()});
  }
  /// Who has connected, if anybody.
  std::optional<TcpPeer> accepted() {
    boost::system::error_code nobody;
    tcp::socket socket(io_);
    acceptor_.accept(socket, nobody);
    if (nobody) return std::nullopt;
    return std::optional<TcpPeer>(std::in_place, std::move(socket));
  }

  /// Holds its port from the start; who listens is up to the test.
  tcp::acceptor acceptor_{io_, tcp::v4()};
};

TEST_F(Val3ClientSocketTest, ConnectsWhenTheProgramUsesItAndAnewWhenThatHasClosed) {
  acceptor_.listen();
  look();
  look();
  EXPECT_FALSE(accepted()) << "the program has not used it";
  for (const std::string round : {"first", "second"}) {
    EXPECT_FALSE(channel_.connect()) << round;
    std::optional<TcpPeer> peer;
    ASSERT_TRUE(look_until([&] { return (peer = accepted()).has_value(); })) << round;
    ASSERT_TRUE(look_until([&] { return channel_.connect(); })) << round;
    send(round);
    ASSERT_TRUE(look_until([&] { return peer->received() == round; })) << round;
    peer->write("ok");
    ASSERT_TRUE(look_until([&] { return channel_.waiting() == 2; })) << round;
    peer->close();
    read();
    ASSERT_TRUE(look_until([&] { return channel_.peer() == Val3Channel::Peer::kGone; })) << round;
    EXPECT_FALSE(channel_.connect()) << "a connection that is over holds the socket";
    look();
    EXPECT_FALSE(accepted()) << round;
    channel_.close();
    look();
    EXPECT_FALSE(accepted()) << "the program has not used it again";
  }
}

TEST_F(Val3ClientSocketTest, WithoutAPeerTellsItOnceAndTriesAgainWhileTheProgramAsks) {
  channel_.connect();
  ASSERT_TRUE(look_until([&] { return !told_.empty(); }));
  EXPECT_THAT(told_[0],
              AllOf(HasSubstr("no connection to 127.0.0.1:"), HasSubstr("start the program there")));
  acceptor_.listen();
  channel_.connect();
  look();
  look();
  EXPECT_FALSE(accepted()) << "it is too soon";
  now_ += Val3Socket::kConnectAgain;
  channel_.connect();
  EXPECT_TRUE(look_until([&] { return accepted().has_value(); }));
  EXPECT_TRUE(look_until([&] { return told_.size() > 1; }));
  EXPECT_THAT(told_[1], HasSubstr("is connected"));
}

TEST_F(Val3ClientSocketTest, AtTheEndOfTheRunAnAttemptIsGivenUp) {
  acceptor_.listen();
  channel_.connect();
  socket_->exchange(now_);
  socket_->end(now_);
  look();
  look();
  EXPECT_EQ(channel_.peer(), Val3Channel::Peer::kNone);
  EXPECT_FALSE(socket_->is_open());
}

TEST_F(Val3SocketTest, AHostWithoutAnAddressIsRefusedWithTheRemedy) {
  try {
    open({"host", "no host", 80});
    FAIL() << "a name with a blank has no address";
  } catch (const SocketRefusal& refusal) {
    EXPECT_THAT(refusal.what(), AllOf(HasSubstr("Socket\\host: no host has no address"),
                                      HasSubstr("give another host with --socket")));
  }
}

}  // namespace
}  // namespace sim
