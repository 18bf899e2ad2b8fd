#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// Why a problem is not computed: a status of its own and one sentence with numbers and the remedy.
struct Refusal {
  IdentificationStatus status = IdentificationStatus::kBadInput;
  std::string message;
};

/// What makes the problem unfit for computing at all, whatever the touches show.
std::optional<Refusal> find_bad_input(const IdentificationProblem& problem,
                                      const IdentificationOptions& options);

/// Touches sorted by where the nominal arm says that they were made. Indices into the problem's touches.
struct Sorted {
  std::vector<std::size_t> fitted;
  std::vector<RejectedTouch> wrong_plane;  // of any role but proof
  std::optional<Refusal> refusal;          // a touch off every plane
};

/// A touch over kFarOffMetres off its plane is on the wrong plane when another one is within
/// kOnOtherPlaneMetres; off all of them it is no touch of this block.
Sorted sort_touches(const IdentificationProblem& problem, const IdentificationOptions& options);

/// Touches that cannot do, however they are computed: too few, all on one plane, one posture again and again.
std::optional<Refusal> find_too_little(const IdentificationProblem& problem,
                                       const std::vector<std::size_t>& fitted, int needed);

/// Unknowns of which neither a standard deviation nor the touches say anything, by name. Columns that were
/// chosen because the touches show them need no standard deviation. Leaves the fit linearised at the
/// estimate.
std::optional<Refusal> find_untold(const IdentificationProblem& problem, const IdentificationOptions& options,
                                   LeastSquares& fit, const Estimate& estimate);

}  // namespace calib
