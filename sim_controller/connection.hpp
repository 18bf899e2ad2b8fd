#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <vector>

#include "sim_controller/link_faults.hpp"

namespace sim {

/// One connection of the server and what waits to be sent on it, with everything that a planned fault makes
/// of it. Kept alive by the handlers that run on it.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  /// How long a closed connection is still read, so that the last message is not lost to a reset.
  static constexpr std::chrono::milliseconds kLingerMax{500};
  /// A host that does not read is closed when this many frames wait.
  static constexpr std::size_t kQueueMax = 1000;
  /// Send buffer of TCP, after that queue: a larger one keeps minutes of States for a host that does not
  /// read.
  static constexpr int kSendBufferBytes = 8192;

  explicit Connection(boost::asio::ip::tcp::socket accepted);

  boost::asio::ip::tcp::socket socket;

  /// No more frames are taken, and none are read.
  [[nodiscard]] bool closing() const { return closing_; }
  [[nodiscard]] bool half_open() const { return half_open_; }

  /// Waits its turn. A State is left out when others wait, or a fault wants it so.
  void send(std::vector<std::uint8_t> frame, bool is_state);
  /// The same with the link faults that apply to this frame; its bytes are already altered.
  void send_with(const std::vector<LinkFault>& faults, std::vector<std::uint8_t> frame, bool is_state);

  /// What a fault of the connection makes of it, now; another kind changes nothing.
  void meet(const LinkFault& fault);
  void go_silent() { silent_ = true; }
  void stop_states(double seconds);  // 0: for good
  /// As if the cable were pulled: from here nothing is sent, not even the end. The socket is closed a minute
  /// later.
  void go_half_open();
  /// Until a half-open connection is closed; it ends with a system_error then.
  boost::asio::awaitable<void> left_alone();

  /// Does it when so much time has passed, unless the connection is closed before.
  void later(double seconds, std::function<void()> act);

  /// Sends what waits, then ends the connection: when the other side closes too, or after half a second.
  void begin_close();
  void close_now();

 private:
  void enqueue(std::vector<std::uint8_t> bytes);
  void hold(std::vector<std::uint8_t> frame, double seconds);
  void write_first();
  void end_sending();

  boost::asio::steady_timer linger_;
  std::list<boost::asio::steady_timer> timers_;  // of later()
  std::deque<std::vector<std::uint8_t>> queue_;  // the first is being written
  std::vector<std::vector<std::uint8_t>> held_;  // late frames, in their order
  std::vector<std::uint8_t> glued_;              // goes before the next frame, in one write
  std::chrono::steady_clock::time_point states_from_{};
  bool closing_ = false;
  bool silent_ = false;
  bool half_open_ = false;
};

}  // namespace sim
