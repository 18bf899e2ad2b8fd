#pragma once

#include <boost/asio/awaitable.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "cs8_protocol/client.hpp"

namespace cell {

/// The robot controller as this folder uses it: one connection at a time, one motion command at a time. The
/// real one is Cs8Controller; a test scripts its own. What each call does and how it fails: cs8::Client.
class Controller {
 public:
  virtual ~Controller() = default;

  /// Sets the hooks (cs8::ClientHooks); call it once, before connect().
  virtual void listen(cs8::ClientHooks hooks) = 0;

  /// Looks up the host, then connects and shakes hands.
  virtual boost::asio::awaitable<cs8::ConnectReply> connect(cs8::ExpectedController expected) = 0;
  virtual void close() = 0;
  [[nodiscard]] virtual bool connected() const = 0;

  virtual boost::asio::awaitable<cs8::PermitReply> begin(std::uint32_t run,
                                                         std::chrono::milliseconds confirm_within) = 0;
  virtual void finish() = 0;
  [[nodiscard]] virtual std::optional<cs8::Permit> latest_permit() const = 0;

  [[nodiscard]] virtual std::optional<cs8::State> latest_state() const = 0;

  [[nodiscard]] virtual std::uint32_t next_sequence() const = 0;
  /// Sent when these are called, before they return; await the reply at once.
  virtual boost::asio::awaitable<cs8::TouchReply> touch(cs8::Touch command) = 0;
  virtual boost::asio::awaitable<cs8::MoveReply> travel(cs8::Travel command) = 0;
  virtual boost::asio::awaitable<cs8::MoveReply> retract(cs8::Retract command) = 0;
  virtual boost::asio::awaitable<cs8::QueryReply> query(std::uint32_t sequence,
                                                        std::chrono::milliseconds deadline) = 0;
  virtual void stop() = 0;
  virtual void acknowledge(std::uint32_t sequence) = 0;
};

}  // namespace cell
