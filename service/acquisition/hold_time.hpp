#pragma once

#include <chrono>
#include <optional>

#include "service/run/packml_state.hpp"

namespace cell {

/// How long a run has stood still, on hold or suspended: a permit and a reference place do not keep their
/// worth for ever. What ends a standstill is a touch that was made, not the state EXECUTE: a run that goes on
/// and is held before its next touch has stood still all the time. A pure value; the time is handed in.
class HoldTime {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// Behind a longer one the reference place is touched first: the arm has cooled down meanwhile, and people
  /// have passed.
  static constexpr std::chrono::minutes kReferenceMax{10};

  /// `touches_done` are those of the run at this time.
  void on_entered(State state, int touches_done, TimePoint now);
  /// A person has confirmed the run: a permit is as old as that at most.
  void on_confirmed(TimePoint now) { confirmed_at_ = now; }
  /// Longer than this, until now. Never while the arm moves.
  [[nodiscard]] bool exceeds(std::chrono::minutes limit, TimePoint now) const {
    return since_ && !is_moving_ && now - *since_ > limit;
  }
  /// The same since the last confirmation.
  [[nodiscard]] bool outlives_permit(std::chrono::minutes limit, TimePoint now) const {
    return exceeds(limit, now) && (!confirmed_at_ || now - *confirmed_at_ > limit);
  }

 private:
  std::optional<TimePoint> since_;
  int touches_done_ = 0;  // when the arm moved last, or the hold began
  bool is_moving_ = false;
  std::optional<TimePoint> confirmed_at_;
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
