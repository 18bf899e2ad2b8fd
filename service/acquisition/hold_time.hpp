#pragma once

#include <chrono>
#include <optional>

#include "service/run/packml_state.hpp"

namespace cell {

/// How long a run has stood still, on hold or suspended: a permit and a reference place do not keep their
/// worth for ever. A pure value; the time is handed in.
class HoldTime {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Behind a longer one the reference place is touched first: the arm has cooled down meanwhile, and people
  /// have passed.
  static constexpr std::chrono::minutes kReferenceMax{10};

  /// A resumption that does not succeed goes on with the hold.
  void on_entered(State state, TimePoint now);
  /// Longer than this, until now.
  [[nodiscard]] bool exceeds(std::chrono::minutes limit, TimePoint now) const {
    return since_ && now - *since_ > limit;
  }

 private:
  std::optional<TimePoint> since_;
};

/// How long a run has made touches, without its holds: what is left takes as long in proportion. A pure
/// value; the time is handed in.
class WorkTime {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  WorkTime() = default;
  /// Goes on behind what an earlier daemon worked.
  explicit WorkTime(std::chrono::duration<double> before) : before_(before) {}

  void on_entered(State state, TimePoint now);
  [[nodiscard]] std::chrono::duration<double> until(TimePoint now) const {
    return before_ + (since_ ? now - *since_ : TimePoint::duration::zero());
  }

 private:
  std::chrono::duration<double> before_{};
  std::optional<TimePoint> since_;
};

}  // namespace cell
