#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cell {

/// The names of sinks, as in the table of cursors.
inline constexpr std::string_view kMqttSink = "mqtt";
inline constexpr std::string_view kArchiveSink = "archive";

/// From so many facts on a sink is far behind: the log and `/readyz` say so.
inline constexpr std::int64_t kFarBehindFacts = 100'000;

/// How far a sink of the outbox has come, and what is in its way.
struct SinkState {
  std::string sink;
  std::int64_t behind = 0;               // facts that it has not confirmed
  std::optional<std::string> oldest_at;  // of the first of them, RFC 3339
  bool connected = false;
  std::optional<std::string> trouble;  // why it is not connected, or does not confirm

  bool operator==(const SinkState&) const = default;
};

/// The states of the configured sinks: each thread of a sink tells its own, any thread reads.
class SinkStates {
 public:
  void set(SinkState state) {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find(states_, state.sink, &SinkState::sink);
    if (known == states_.end()) {
      states_.push_back(std::move(state));
    } else {
      *known = std::move(state);
    }
  }
  [[nodiscard]] std::vector<SinkState> all() const {
    const std::lock_guard lock(mutex_);
    return states_;
  }
  /// Nothing for a sink that is not configured.
  [[nodiscard]] std::optional<SinkState> of(std::string_view sink) const {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find(states_, sink, &SinkState::sink);
    return known == states_.end() ? std::nullopt : std::optional(*known);
  }

 private:
  mutable std::mutex mutex_;
  std::vector<SinkState> states_;
};

}  // namespace cell
