#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace cell {

/// How often somebody guessed wrong, by a key that says who: so many at once, then one in a time. Counted by
/// time alone. Of one thread.
class GuessCounts {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  static constexpr int kAtOnce = 5;                         // typing errors
  static constexpr std::chrono::minutes kForgetOne{1};      // one of them is forgotten in this time
  static constexpr std::chrono::minutes kForgetAllMax{15};  // all of them, however many there were
  static constexpr std::size_t kKeysMax = 1024;

  /// Counts one more. Whether there were more than are forgiven. Where kKeysMax are known, the one that has
  /// been quiet longest goes for a new one.
  bool add(std::string key, TimePoint now);
  /// How long until one more is forgiven; zero where it is now.
  [[nodiscard]] std::chrono::steady_clock::duration wait(const std::string& key, TimePoint now) const;
  /// What this key has guessed is forgotten.
  void forgive(const std::string& key) { counts_.erase(key); }

  [[nodiscard]] std::size_t size() const { return counts_.size(); }

 private:
  struct Count {
    TimePoint forgotten_at{};  // when all of them are forgotten
    TimePoint latest{};
  };
  Count& count_of(std::string key);

  std::map<std::string, Count> counts_;
};

}  // namespace cell
