#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/geometry/units.hpp"

/// Which of the errors that a joint's gear repeats with its position these touches can tell from the offset
/// of the joint (its theta), before any fit.
namespace calib {

/// A joint that the touches turn through less (radians; the turn of an even spread with their standard
/// deviation) does not tell its first harmonic from its offset: at 45 degrees a fifth of the one and a
/// fiftieth of the other component is left beside it, at 20 degrees a tenth and a two-hundredth.
inline constexpr double kHarmonicTurnMin = 45.0 * kRadiansPerDegree;

/// Of a ripple's cosine and sine at these touches, the weaker combination: the share of its mean square that
/// an offset and a first harmonic must leave. An even spread over one period leaves two thirds and more.
inline constexpr double kRippleShareMin = 0.1;

struct GearColumns {
  /// Positions in nongeometric_parameters() of what has a standard deviation and can be told, ascending.
  std::vector<int> positions;
  /// Those of one joint each that have a standard deviation and cannot be told: "joint 2 (20 degrees)".
  std::string held;
};

/// The first harmonics. `fitted`: indices of touches.
GearColumns shown_harmonics(const IdentificationProblem& problem, const std::vector<std::size_t>& fitted);

/// The ripples of joints that the touches turn through at least one period, and not by whole periods from
/// touch to touch.
GearColumns shown_ripples(const IdentificationProblem& problem, const std::vector<std::size_t>& fitted);

}  // namespace calib
