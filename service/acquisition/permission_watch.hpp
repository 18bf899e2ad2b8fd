#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "cs8_protocol/messages.hpp"
#include "service/run/fault_table.hpp"

namespace cell {

/// What a State says against an arm that moves, in words; empty when it says nothing.
std::string lost_permission(const cs8::State& state);

/// Watches what the controller's State says while a run has its permit. A controller that takes the
/// permission away ends the command and says so in its answer, which comes first; this is for one that says
/// it in State alone, and for one that tells no State any more.
class PermissionWatch {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  /// The answer to a command may take as long as this behind the State that says why it ends.
  static constexpr std::chrono::milliseconds kAnswerPatience{500};
  /// So many heartbeats, 100 ms apart, without a State are too many. They are counted instead of the time:
  /// while this process stands still, none are sent and no State is read.
  static constexpr int kSilentHeartbeatsMax = 10;

  void on_state(const cs8::State& state, TimePoint now);
  void on_heartbeat() { ++heartbeats_without_state_; }

  /// What the two newest States both say, so that none is meant that was made before a permit was given;
  /// empty when they say nothing.
  [[nodiscard]] std::string told() const { return lost_count_ > 1 ? lost_ : std::string(); }
  /// What must hold the run.
  [[nodiscard]] std::optional<Fault> fault(TimePoint now) const;

 private:
  std::string lost_;
  int lost_count_ = 0;  // States in a row
  TimePoint lost_since_;
  int heartbeats_without_state_ = 0;
};

}  // namespace cell
