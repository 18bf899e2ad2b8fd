#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "tests/simulation/virtual_clock.hpp"

namespace simulation {

/// A turn of an io_context in which it may wait: instead it is stopped where it would, and tells for how
/// long. On one thread, one at a time.
class WaitingTurn {
 public:
  /// `stop` ends the turn (io_context::stop).
  explicit WaitingTurn(std::function<void()> stop);
  ~WaitingTurn();
  WaitingTurn(const WaitingTurn&) = delete;
  WaitingTurn& operator=(const WaitingTurn&) = delete;

  void on_wait(int timeout_ms);
  /// Nothing when no timer is set, or when it had something to do.
  [[nodiscard]] std::optional<Time> until_next_timer() const { return until_next_timer_; }

 private:
  std::function<void()> stop_;
  std::optional<Time> until_next_timer_;
};

}  // namespace simulation
