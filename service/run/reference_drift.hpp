#pragma once

#include <optional>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"

namespace cell {

/// What the touches of the reference place say of a run.
struct ReferencePlace {
  /// How far it moved, metres: the line through its readings from the first to the last, less what their
  /// noise alone would make of it. 0 when there are fewer than three, and when noise alone makes as much in
  /// more than 3 of 1,000 runs.
  double trend_m = 0.0;
  std::optional<calib::TouchNoise> scatter;  // about that line
};

/// Of the distances of one place in the order in which they were made.
ReferencePlace reference_place(const std::vector<double>& readings_m);

/// Notes in the problem of a run what the touches at its reference place say, in the order in which they were
/// made: the heights of calib::counted_readings() over the nominal face by the nominal arm.
void note_references(const std::vector<calib::Touch>& at_place, calib::IdentificationProblem& problem);

}  // namespace cell
