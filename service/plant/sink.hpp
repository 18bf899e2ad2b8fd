#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>

#include "service/store/outbox.hpp"

namespace cell {

/// Why a sink cannot take facts now, and what to do.
class SinkTrouble : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Who hears of the facts: a connection to another system. It is made, used and destroyed on one thread, the
/// only one that its library runs on; making it connects. Each call throws SinkTrouble when the other side
/// cannot be used, and the sink is destroyed then.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Hands over the facts, of which there is at least one, oldest first. Returns the number up to which the
  /// other side has confirmed to keep them, which is at least that of the first; nothing is confirmed by a
  /// call that throws. Facts that come once more are harmless. Returns early when `ending`, with what was
  /// confirmed before the first as well.
  virtual std::int64_t deliver(std::span<const Fact> facts, std::stop_token ending) = 0;
  /// There is no fact: keeps the connection alive for about `time`.
  virtual void rest(std::chrono::milliseconds time, std::stop_token ending) = 0;
  /// The number of the last fact that the other side has, 0 for none, as it said when this connected: one
  /// that was emptied or restored from a backup has less than it once confirmed. Nothing of one that cannot
  /// say.
  [[nodiscard]] virtual std::optional<std::int64_t> last_kept() const { return std::nullopt; }
  /// What a person has to look at though the other side takes facts.
  [[nodiscard]] virtual std::optional<std::string> remark() const { return std::nullopt; }
};

}  // namespace cell
