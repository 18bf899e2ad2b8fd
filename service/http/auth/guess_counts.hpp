#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace cell {

/// How often somebody guessed wrong, by a key that says who: so many at once, then one in a time. Counted by
/// time alone. Of one thread.
///
/// What it holds back: a key has kAtOnce guesses and one a kForgetOne after that, 1,445 in the first day and
/// 525,605 in a year. Of the million PINs of six digits that is one in 700 a day, 1 % a week and every second
/// one in a year, if they are drawn; people's own choices fall sooner. Keys that differ in the network add
/// up: ten addresses find half of them in five weeks. It slows guessing down until somebody sees it in the
/// audit; it does not make a PIN a passphrase.
class GuessCounts {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  static constexpr int kAtOnce = 5;                         // typing errors
  static constexpr std::chrono::minutes kForgetOne{1};      // one of them is forgotten in this time
  static constexpr std::chrono::minutes kForgetAllMax{15};  // all of them, however many there were
  static constexpr std::size_t kKeysMax = 1024;

  /// Counts one more. Whether there were more than are forgiven. Where kKeysMax are known, the one that is
  /// forgotten soonest goes for a new one: to be rid of a count, kKeysMax others with as many wrong guesses
  /// have to be made, each with its own waits. Who has that many networks is not held back by this.
  bool add(std::string key, TimePoint now);
  /// How long until one more is forgiven; zero where it is now.
  [[nodiscard]] std::chrono::steady_clock::duration wait(const std::string& key, TimePoint now) const;
  /// Whether something of this key is not forgotten yet.
  [[nodiscard]] bool knows(const std::string& key, TimePoint now) const;
  /// One that was counted was none.
  void take_back(const std::string& key);
  /// What this key has guessed is forgotten.
  void forgive(const std::string& key) { forgotten_at_.erase(key); }

  [[nodiscard]] std::size_t size() const { return forgotten_at_.size(); }

 private:
  std::map<std::string, TimePoint> forgotten_at_;  // when all guesses of a key are
};

}  // namespace cell
