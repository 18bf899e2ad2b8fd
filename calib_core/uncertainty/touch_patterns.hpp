#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

/// What displaces every touch by a pattern that touches do not show well enough to be estimated. Within its
/// standard deviation each bends the estimate.
namespace calib {

/// One such effect; its size has this standard deviation around 0.
struct TouchPattern {
  const char* source = "";  // in the uncertainty budget; several effects may share one
  double std = 0.0;         // radians of lag, metres of pre-travel
};

/// The lag of each joint behind its drive ("backlash"), where any is known; then the pre-travel of a push
/// from the side, each that has a deviation: "pretravel_tilt", and "lobes" in two directions.
std::vector<TouchPattern> touch_patterns(const IdentificationProblem& problem);

/// d (weighted distance of a touch) / d (size of an effect): rows as those of `fit`, columns as
/// touch_patterns(); 0 for touches that are not kept. The columns of `fit` must begin with the candidates,
/// and it must be linearised.
Eigen::MatrixXd pattern_displacements(const IdentificationProblem& problem, const LeastSquares& fit,
                                      const Estimate& estimate);

}  // namespace calib
