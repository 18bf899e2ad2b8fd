#pragma once

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace cell {

/// How many refusals of strangers are recorded: a flood of them must not load the disk. So many at once, and
/// one more a period after that.
class RecordRate {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  RecordRate(int at_once, std::chrono::milliseconds period) : at_once_(at_once), period_(period) {}

  /// Whether to record one now: then how many were left out since the last one that was recorded.
  std::optional<int> admit(TimePoint now) {
    // Each record moves this ahead by a period; it may be ahead of the clock by at_once_ periods.
    const TimePoint next = std::max(used_until_, now) + period_;
    if (next - now > at_once_ * period_) {
      ++left_out_;
      return std::nullopt;
    }
    used_until_ = next;
    return std::exchange(left_out_, 0);
  }

  /// How many were left out since the last one that was recorded, which they are now.
  int take_left_out() { return std::exchange(left_out_, 0); }

 private:
  int at_once_;
  std::chrono::milliseconds period_;
  TimePoint used_until_{};
  int left_out_ = 0;
};

}  // namespace cell
