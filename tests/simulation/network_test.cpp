#include "tests/simulation/network.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cerrno>

namespace simulation {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kPort = 11'000;

class NetworkTest : public ::testing::Test {
 protected:
  NetworkTest() {
    network_.bind(listener_, kPort);
    network_.listen(listener_);
  }
  /// The descriptors of host and controller.
  std::pair<int, int> connect() {
    const int host = network_.open_socket();
    EXPECT_EQ(network_.connect(host, kPort), -1);
    EXPECT_EQ(errno, EINPROGRESS);
    pass(1ms);
    return {host, network_.accept(listener_)};
  }
  void pass(Time time) {
    clock_.advance_to(clock_.now() + time);
    network_.deliver();
  }
  std::int64_t send(int from, std::size_t size) {
    return network_.send(from, std::vector<std::uint8_t>(size, std::uint8_t{7}));
  }
  std::int64_t receive(int at) {
    std::array<std::uint8_t, 100'000> bytes{};
    return network_.receive(at, bytes.data(), bytes.size());
  }

  VirtualClock clock_;
  Network network_{clock_, 1};
  int listener_ = network_.open_socket();
};

TEST_F(NetworkTest, BytesArriveAfterTheLatency) {
  const auto [host, controller] = connect();
  EXPECT_EQ(send(host, 3), 3);
  EXPECT_EQ(receive(controller), -1);
  EXPECT_EQ(errno, EAGAIN);
  EXPECT_EQ(network_.next_due(), clock_.now() + network_.conditions.latency);
  pass(1ms);
  EXPECT_EQ(receive(controller), 3);
}

TEST_F(NetworkTest, AnEndIsReadBehindTheLastByte) {
  const auto [host, controller] = connect();
  send(controller, 2);
  network_.close(controller);
  pass(1ms);
  EXPECT_EQ(receive(host), 2);
  EXPECT_EQ(receive(host), 0);
}

TEST_F(NetworkTest, ClosingOnUnreadBytesTakesBackWhatIsNotReadYet) {
  const auto [host, controller] = connect();
  send(host, 1);
  pass(1ms);
  send(controller, 2);
  network_.close(controller);
  pass(1ms);
  EXPECT_EQ(receive(host), -1);
  EXPECT_EQ(errno, ECONNRESET);
}

TEST_F(NetworkTest, NothingOvertakesInPieces) {
  const auto [host, controller] = connect();
  network_.conditions.piece_max = 3;
  std::vector<std::uint8_t> sent(100);
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::uint8_t>(i);
  network_.send(host, sent);
  std::vector<std::uint8_t> received;
  int reads = 0;
  while (received.size() < sent.size()) {
    clock_.advance_to(network_.next_due().value());
    network_.deliver();
    std::array<std::uint8_t, 200> bytes{};
    const auto count = network_.receive(controller, bytes.data(), bytes.size());
    received.insert(received.end(), bytes.begin(), bytes.begin() + count);
    ++reads;
  }
  EXPECT_EQ(received, sent);
  EXPECT_GE(reads, 34);
}

TEST_F(NetworkTest, ACutIsToldToBothAndAHalfOpenConnectionToNobody) {
  const auto [host, controller] = connect();
  network_.half_open();
  EXPECT_EQ(send(host, 1), 1);
  pass(1min);
  EXPECT_EQ(receive(controller), -1);
  EXPECT_EQ(errno, EAGAIN);
  network_.cut();
  EXPECT_EQ(receive(host), -1);
  EXPECT_EQ(errno, ECONNRESET);
  EXPECT_EQ(receive(controller), -1);
  EXPECT_EQ(errno, ECONNRESET);
}

TEST_F(NetworkTest, WhoDoesNotReadIsNotSentMore) {
  const auto [host, controller] = connect();
  EXPECT_EQ(send(host, 60'000), 60'000);
  EXPECT_EQ(send(host, 10'000), 5'536);
  EXPECT_EQ(send(host, 1), -1);
  EXPECT_EQ(errno, EAGAIN);
  pass(1ms);
  EXPECT_EQ(receive(controller), 65'536);
  EXPECT_EQ(send(host, 10'000), 10'000);
}

TEST_F(NetworkTest, WhatTheCableSuffersConnectionsToOtherPortsDoNot) {
  network_.cable_port = kPort + 1;
  network_.conditions.swallows = true;
  const auto [client, host] = connect();
  network_.cut();
  network_.half_open();
  EXPECT_EQ(send(client, 3), 3);
  pass(1ms);
  EXPECT_EQ(receive(host), 3);
  network_.silence_host();
  EXPECT_EQ(send(host, 3), 3);
  pass(1ms);
  EXPECT_EQ(receive(client), -1);
  EXPECT_EQ(errno, EAGAIN) << "the process is dead";
}

TEST_F(NetworkTest, WhereNobodyListensAConnectionIsRefused) {
  const int host = network_.open_socket();
  network_.connect(host, 12'000);
  EXPECT_EQ(network_.readiness(host), 0u);
  pass(1ms);
  EXPECT_NE(network_.readiness(host) & EPOLLERR, 0u);
  EXPECT_EQ(network_.take_error(host), ECONNREFUSED);
}

TEST_F(NetworkTest, ReadinessIsToldOnceUntilSomethingArrives) {
  const auto [host, controller] = connect();
  const int epoll = network_.open_epoll();
  epoll_event wanted{.events = EPOLLIN | EPOLLET, .data = {.u64 = 42}};
  network_.control(epoll, EPOLL_CTL_ADD, controller, &wanted);
  std::array<epoll_event, 8> told{};
  const auto collect = [&] { return network_.collect(epoll, told.data(), static_cast<int>(told.size())); };
  EXPECT_EQ(collect(), 0);
  send(host, 1);
  pass(1ms);
  ASSERT_EQ(collect(), 1);
  EXPECT_EQ(told[0].data.u64, 42u);
  EXPECT_EQ(collect(), 0);
  send(host, 1);
  pass(1ms);
  EXPECT_EQ(collect(), 1);
}

}  // namespace
}  // namespace simulation
