#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <thread>

namespace cell {

/// Watches over the end of a process: what is still to be written and closed may wait for a disk that does
/// not answer any more. On a thread of its own, since who waits for a disk looks at no clock.
class EndWatch {
 public:
  /// After a signal: just long enough for a disk that answers.
  static constexpr std::chrono::milliseconds kHurriedPatience{1'000};

  /// Called on the watch's thread, with the reason in words, when the end is waited for no longer.
  using GiveUp = std::function<void(const std::string& why)>;

  EndWatch() = default;
  /// The end came in time, unless it was given up.
  ~EndWatch();
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  /// From here on the end may take `patience`, then it is given up. SIGINT, SIGTERM or SIGHUP leave it
  /// kHurriedPatience. Once.
  void begin(std::chrono::milliseconds patience, GiveUp give_up);

 private:
  void watch(std::chrono::milliseconds patience, const GiveUp& give_up);

  boost::asio::io_context context_{1};
  std::optional<boost::asio::signal_set> signals_;
  bool came_in_time_ = false;  // of the thread
  std::thread thread_;
};

}  // namespace cell
