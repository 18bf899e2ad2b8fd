#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <pqxx/connection_base.hxx>
#include <stop_token>
#include <thread>

namespace cell {

/// How long a server may take to answer, for the time that this lives: then, or when `ending` asks for it,
/// the socket is shut down, and whoever waits at the connection gets a failure. The library itself waits
/// without an end for a server that takes what it is sent and does not answer.
class Patience {
 public:
  Patience(const pqxx::connection_base& connection, std::chrono::milliseconds time,
           std::stop_token ending = {});
  Patience(const Patience&) = delete;
  Patience& operator=(const Patience&) = delete;

  /// The time begins anew: each answer over a long line takes its own.
  void answered();
  [[nodiscard]] bool is_over() const { return is_over_; }

 private:
  int socket_;
  std::atomic<bool> is_over_ = false;
  std::mutex mutex_;
  std::condition_variable_any woken_;
  int answers_ = 0;
  std::stop_callback<std::function<void()>> at_ending_;
  std::jthread thread_;  // the last member: it uses the others
};

}  // namespace cell
