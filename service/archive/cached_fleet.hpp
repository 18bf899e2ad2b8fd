#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

namespace cell {

/// Documents of all cells for those who look again and again: each is asked of the archive once in
/// kKept, also where that failed, whoever looks. Of one thread.
class CachedFleet {
 public:
  using Steady = std::chrono::steady_clock::time_point;

  /// How old a document may be.
  static constexpr std::chrono::seconds kKept{15};
  /// How long a query may take.
  static constexpr std::chrono::milliseconds kPatience{5'000};

  CachedFleet(std::string url, std::function<Steady()> clock);

  /// touchcal/fleet/1. Throws std::runtime_error where the archive cannot be read, as do the next.
  std::string fleet();
  /// touchcal/fleet-trends/1.
  std::string trends(int months);

 private:
  struct Answer {
    Steady at;
    std::string text;
  };

  std::string answer(const std::string& key, const std::function<std::string()>& ask);

  std::string url_;
  std::function<Steady()> clock_;
  std::map<std::string, Answer> answers_;
  std::optional<Answer> failure_;  // whatever was asked for
};

}  // namespace cell
