#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"

namespace cell {

/// What the touches of the reference place say of a run.
struct ReferencePlace {
  /// How far it moved, metres: the line through its readings from the first to the last, less what their
  /// noise alone would make of it. 0 when there are fewer than three, and when noise alone makes as much in
  /// more than 3 of 1,000 runs.
  double trend_m = 0.0;
  /// One standard deviation of that, whether it is significant or not: a drift that the scatter hides is
  /// still there. 0 when there are fewer than three.
  calib::TouchNoise open_trend;
  std::optional<calib::TouchNoise> scatter;  // about that line
};

/// Of the distances of one place in the order in which they were made. `times_s` as in calib::line_through().
ReferencePlace reference_place(const std::vector<double>& readings_m, std::span<const double> times_s = {});

}  // namespace cell
