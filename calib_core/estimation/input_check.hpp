#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// Why a problem cannot be computed: the status, and one sentence with figures and the remedy.
struct InputRefusal {
  IdentificationStatus status = IdentificationStatus::kBadInput;
  std::string message;
};

/// Checks everything that makes a computation impossible, such as numbers that are not finite.
std::optional<InputRefusal> find_invalid_input(const IdentificationProblem& problem,
                                               const IdentificationOptions& options);

/// Touches classified by their distance from the faces, by the nominal arm. Indices into the touches of the
/// problem.
struct SortedTouches {
  std::vector<std::size_t> fitted;
  std::vector<RejectedTouch> wrong_face;  // of every role except kProof
  std::optional<InputRefusal> refusal;    // a touch far from every face
};

/// See kFarOffMetres and kOnOtherPlaneMetres.
SortedTouches sort_touches(const IdentificationProblem& problem, const IdentificationOptions& options);

/// Touches that cannot determine an arm: too few, all on one face, or all in one posture.
std::optional<InputRefusal> find_insufficient_data(const IdentificationProblem& problem,
                                                   const std::vector<std::size_t>& fitted, int needed);

/// A sphere whose centre is to be found in place is touched from directions whose components along any axis
/// through it are at least this, root mean square: the sine of 10 degrees. With less its centre and the arm
/// look alike. Of a bore whose axis is to be found the same holds for any direction across the axis.
inline constexpr double kSphereSidesMin = 0.17364817766693033;

/// A sphere without a prior on its centre that was touched from one side only, or in one plane; a bore
/// without one on the place of its axis that was touched on one side of it only.
std::optional<InputRefusal> find_one_sided_face(const IdentificationProblem& problem,
                                                const std::vector<std::size_t>& fitted);

/// Unknowns that neither a prior nor the touches constrain, by name. Columns that were chosen as identifiable
/// need no prior. Linearises the fit at the estimate.
std::optional<InputRefusal> find_unconstrained(const IdentificationProblem& problem,
                                               const IdentificationOptions& options, LeastSquares& fit,
                                               const Estimate& estimate);

}  // namespace calib
