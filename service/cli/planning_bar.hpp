#pragma once

#include <string_view>

#include "calib_core/planning/touch_planning.hpp"

namespace cell {

/// Shows the progress of planning, or of another computation that takes seconds, on standard error: a line
/// that is redrawn on a terminal, nothing elsewhere.
class PlanningBar {
 public:
  explicit PlanningBar(bool on_terminal) : on_terminal_(on_terminal) {}

  void show(std::string_view stage, double share);
  /// show(), for as long as the bar is there.
  [[nodiscard]] calib::PlanningProgress progress() {
    return [this](std::string_view stage, double share) { show(stage, share); };
  }
  /// Erases the line.
  void finish();

 private:
  bool on_terminal_;
  int shown_percent_ = -1;
};

}  // namespace cell
