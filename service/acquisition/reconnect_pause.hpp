#pragma once

#include <chrono>
#include <optional>

namespace cell {

/// When the controller may be tried again: at once at first, then after pauses that grow, also where each try
/// gives a link that dies soon. A link that lasted ends the growth. After any link there is a pause, in which
/// the other side notices its end and can take the next one.
class ReconnectPause {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  static constexpr std::chrono::milliseconds kFirst{100};
  static constexpr std::chrono::milliseconds kLongest{2000};
  /// A link that lives as long as this has lasted.
  static constexpr std::chrono::milliseconds kLasts{5000};

  void on_try(TimePoint now, bool linked);
  /// The link was lost, or closed by this side. Nothing without one.
  void on_link_end(TimePoint now);

  /// Not before then.
  [[nodiscard]] TimePoint earliest() const { return earliest_; }
  /// Links in a row that did not last.
  [[nodiscard]] int short_links() const { return short_links_; }

 private:
  TimePoint earliest_;
  std::chrono::milliseconds pause_ = kFirst;
  std::optional<TimePoint> linked_at_;
  int short_links_ = 0;
};

}  // namespace cell
