#pragma once

#include <string_view>

namespace cell {

/// Shows on standard error how far planning is: a line drawn anew on a terminal, nothing elsewhere.
class PlanningBar {
 public:
  explicit PlanningBar(bool on_terminal) : on_terminal_(on_terminal) {}

  /// `share` of all that is to be done, 0 to 1.
  void show(std::string_view stage, double share);
  /// Takes the line away.
  void finish();

 private:
  bool on_terminal_;
  int shown_percent_ = -1;
};

}  // namespace cell
