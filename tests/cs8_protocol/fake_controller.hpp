#pragma once

#include <gtest/gtest.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cs8_protocol/client.hpp"
#include "cs8_protocol/framing.hpp"
#include "cs8_protocol/names.hpp"

/// A scripted controller on a loopback socket, and a fixture with a client that talks to it. Each test says
/// what the controller does on each connection in turn; nothing here knows the protocol's rules.
namespace cs8 {

namespace asio = boost::asio;
using asio::ip::tcp;

/// The controller's side of one connection.
class Peer {
 public:
  explicit Peer(tcp::socket socket) : socket_(std::move(socket)) {}

  /// The next message that is no heartbeat; it must be a `Body`.
  template <class Body>
  asio::awaitable<Body> receive() {
    for (;;) {
      const DecodeResult frame = co_await read_frame(socket_);
      if (const auto* error = std::get_if<DecodeError>(&frame)) throw std::runtime_error(error->text());
      const auto& message = std::get<Message>(frame);
      sequence_ = message.sequence;
      if (const auto* body = std::get_if<Body>(&message.payload)) co_return *body;
      if (!std::holds_alternative<Heartbeat>(message.payload)) {
        throw std::runtime_error("the fake controller was sent " + std::string(name(type_of(message))));
      }
    }
  }

  /// The sequence of the message that was received last.
  [[nodiscard]] std::uint32_t sequence() const { return sequence_; }

  void send(std::uint32_t sequence, Payload payload) {
    send_bytes(encode(Message{sequence, std::move(payload)}));
  }
  void send_bytes(const std::vector<std::uint8_t>& bytes) { asio::write(socket_, asio::buffer(bytes)); }

  asio::awaitable<void> shake_hands(Welcome welcome) {
    co_await receive<Hello>();
    send(0, welcome);
  }

  /// Reads until the host ends the connection.
  asio::awaitable<void> until_closed() {
    try {
      for (;;) co_await read_frame(socket_);
    } catch (const boost::system::system_error&) {
    }
  }

 private:
  tcp::socket socket_;
  std::uint32_t sequence_ = 0;
};

using Script = std::function<asio::awaitable<void>(Peer&)>;
using Work = std::function<asio::awaitable<void>()>;

/// Expects a `T` in a variant and gives it, or a default one.
template <class T, class Variant>
T expect_held(const Variant& variant) {
  if (const auto* held = std::get_if<T>(&variant)) return *held;
  std::string instead = "alternative " + std::to_string(variant.index());
  if (const auto* error = std::get_if<LinkError>(&variant)) instead = error->text;
  ADD_FAILURE() << "holds " << instead;
  return T{};
}

class WithFakeController : public ::testing::Test {
 protected:
  static ClientOptions patient() {
    using std::chrono::seconds;
    return {.connect_deadline = seconds(10),
            .heartbeat_timeout = seconds(10),
            .answer_deadline = seconds(10),
            .result_margin = seconds(10)};
  }
  static ExpectedController expected() {
    return {.application = "touchcal", .arm = "tx90", .lower_limits = lower(), .upper_limits = upper()};
  }
  static Welcome welcome() {
    return {.application = text16("touchcal"),
            .arm = text16("tx90"),
            .application_version = 10000,
            .language_version = 70702,
            .session = 3,
            .heartbeat_timeout_ms = 500,
            .lower_limits = lower(),
            .upper_limits = upper()};
  }
  static JointsMicrodeg lower() {
    return {-180000000, -130000000, -145000000, -270000000, -115000000, -270000000};
  }
  static JointsMicrodeg upper() { return {180000000, 147500000, 145000000, 270000000, 140000000, 270000000}; }

  Client make_client(ClientOptions options = patient()) {
    return Client(io_.get_executor(), options,
                  {.on_state =
                       [this](const State& state) {
                         if (on_state_) on_state_(state);
                       },
                   .on_loss = [this](const LinkError& error) { losses_.push_back(error); }});
  }

  /// The controller takes one connection for each script, in this order.
  void controller_does(std::vector<Script> scripts) {
    asio::co_spawn(io_, serve(std::move(scripts)),
                   [this](const std::exception_ptr& failure) { note(failure); });
  }

  /// Runs `host` and the controller's scripts until nothing of either is left to do: what a client leaves
  /// running after close() shows here.
  void run(Work host) {
    io_.restart();
    asio::co_spawn(io_, host(), [this](const std::exception_ptr& failure) { note(failure); });
    io_.run_for(std::chrono::seconds(20));
    EXPECT_TRUE(io_.stopped()) << "something still waits";
    EXPECT_EQ(failures_, std::vector<std::string>{});
  }

  [[nodiscard]] tcp::endpoint endpoint() const { return acceptor_.local_endpoint(); }

  asio::awaitable<void> connect(Client& client) {
    const ConnectReply reply = co_await client.connect(endpoint(), expected());
    expect_held<Welcome>(reply);
  }

  asio::io_context io_;
  tcp::acceptor acceptor_{io_, tcp::endpoint(asio::ip::address_v4::loopback(), 0)};
  std::function<void(const State&)> on_state_;
  std::vector<LinkError> losses_;

 private:
  asio::awaitable<void> serve(std::vector<Script> scripts) {
    for (const Script& script : scripts) {
      Peer peer(co_await acceptor_.async_accept(asio::use_awaitable));
      co_await script(peer);
    }
  }

  void note(const std::exception_ptr& failure) {
    if (!failure) return;
    try {
      std::rethrow_exception(failure);
    } catch (const std::exception& error) {
      failures_.emplace_back(error.what());
    }
  }

  std::vector<std::string> failures_;
};

}  // namespace cs8
