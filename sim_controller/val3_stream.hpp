#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <span>
#include <string>
#include <vector>

/// TCP connections of VAL3 channels. No call waits; who holds them looks at them again and again.
namespace sim {

/// "127.0.0.1:5000"
std::string address_text(const boost::asio::ip::tcp::endpoint& endpoint);

/// A connection and what is still to be written to it.
class Val3Stream {
 public:
  explicit Val3Stream(boost::asio::ip::tcp::socket connected);

  void set_nagle(bool on);
  [[nodiscard]] std::string peer() const;

  [[nodiscard]] bool has_unsent() const { return sent_ < unsent_.size(); }
  void add(const std::vector<std::uint8_t>& bytes);
  /// Writes what the peer's TCP takes, and returns how many bytes that were.
  std::size_t write(boost::system::error_code& error);
  /// 0 without an error: nothing is there. The peer's end is asio::error::eof.
  std::size_t read(std::span<std::uint8_t> into, boost::system::error_code& error);
  /// The peer sees the end behind what was written.
  void end_sending();

 private:
  boost::asio::ip::tcp::socket socket_;
  std::vector<std::uint8_t> unsent_;
  std::size_t sent_ = 0;  // of them
};

/// Connections that this side has closed: sent to their end, then read until the peer closes too, so that the
/// last bytes are not lost to a reset.
class Val3EndingStreams {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Closed at `until` whatever is left. One more than kEndingStreamsMax closes the oldest.
  void add(Val3Stream stream, TimePoint until);
  void proceed(TimePoint now);
  [[nodiscard]] bool empty() const { return streams_.empty(); }

  static constexpr std::size_t kEndingStreamsMax = 16;

 private:
  struct Ending {
    Val3Stream stream;
    TimePoint until;
    bool is_sent = false;
  };
  static bool has_ended(Ending& ending);

  std::list<Ending> streams_;
};

}  // namespace sim
