#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace cell {

/// A text that one thread replaces and another takes: only the latest counts, and nobody waits.
class LatestText {
 public:
  void put(std::string text) {
    const std::lock_guard lock(mutex_);
    text_ = std::move(text);
    is_new_ = true;
  }
  /// The latest, where there is one that was not taken yet.
  std::optional<std::string> take_new() {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(is_new_, false)) return std::nullopt;
    return text_;
  }
  /// The latest, taken or not; nothing before there is one.
  std::optional<std::string> take() {
    const std::lock_guard lock(mutex_);
    is_new_ = false;
    return text_;
  }

 private:
  std::mutex mutex_;
  std::optional<std::string> text_;
  bool is_new_ = false;
};

}  // namespace cell
