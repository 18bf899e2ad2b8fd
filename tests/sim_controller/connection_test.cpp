#include "sim_controller/connection.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "cs8_protocol/codec.hpp"
#include "sim_controller/frame_stream.hpp"
#include "tests/sim_controller/tcp_peer.hpp"

/// Every fault of a connection is in link_faults_test and server_test.
namespace sim {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// Far longer than bytes take to cross loopback.
constexpr std::chrono::minutes kCrossingPatience{1};

/// A connection and a host that reads when it is told to.
class ConnectionTest : public ::testing::Test {
 protected:
  void send_state() { send({++states_made_, cs8::State{}}); }
  void send_unknown(std::uint32_t sequence) { send({sequence, cs8::ResultUnknown{sequence}}); }

  /// Reads on until this message has come; how many States did before it.
  template <class Payload>
  int states_before(std::uint32_t sequence) {
    int states = 0;
    const auto deadline = std::chrono::steady_clock::now() + kCrossingPatience;
    while (std::chrono::steady_clock::now() < deadline) {
      for (; !read_.empty(); read_.pop_front()) {
        if (read_.front().sequence == sequence && std::holds_alternative<Payload>(read_.front().payload))
          return states;
        if (std::holds_alternative<cs8::State>(read_.front().payload)) ++states;
      }
      carry();
      read();
    }
    ADD_FAILURE() << "it does not come";
    return states;
  }

 private:
  void send(const cs8::Message& message) {
    connection_->send(cs8::encode(message), std::holds_alternative<cs8::State>(message.payload));
    carry();
  }
  /// What can be done at once.
  void carry() {
    io_.restart();
    io_.poll();
  }
  void read() {
    const std::string& all = host_.received();
    const std::vector<std::uint8_t> fresh(all.begin() + static_cast<std::ptrdiff_t>(looked_at_), all.end());
    looked_at_ = all.size();
    for (const FrameStream::Piece& piece : frames_.feed(fresh)) read_.push_back(piece.message.value());
  }

 protected:
  asio::io_context io_{1};
  tcp::acceptor acceptor_{io_, {asio::ip::address_v4::loopback(), 0}};
  testing::TcpPeer host_{io_, acceptor_.local_endpoint().port(), 4096};
  std::shared_ptr<Connection> connection_ = std::make_shared<Connection>(acceptor_.accept());
  std::uint32_t states_made_ = 0;

 private:
  FrameStream frames_;
  std::size_t looked_at_ = 0;
  std::deque<cs8::Message> read_;  // and not asked for yet
};

TEST_F(ConnectionTest, StatesThatTheHostDoesNotReadAreLeftOutAndNotKeptForIt) {
  constexpr std::uint32_t kOfFortySeconds = 2'000;
  constexpr int kOfTenSeconds = 500;
  while (states_made_ < kOfFortySeconds) send_state();
  send_unknown(7);
  const int kept = states_before<cs8::ResultUnknown>(7);
  EXPECT_GT(kept, 0);
  EXPECT_LT(kept, kOfTenSeconds);
  send_state();
  EXPECT_EQ(states_before<cs8::State>(states_made_), 0) << "the next one has room again";
}

TEST_F(ConnectionTest, AnswersThatTheHostDoesNotReadWait) {
  constexpr std::uint32_t kAnswers = 100;
  for (int i = 0; i < 1'000; ++i) send_state();
  for (std::uint32_t i = 1; i <= kAnswers; ++i) send_unknown(i);
  EXPECT_FALSE(connection_->closing());
  for (std::uint32_t i = 1; i <= kAnswers; ++i) states_before<cs8::ResultUnknown>(i);
}

}  // namespace
}  // namespace sim
