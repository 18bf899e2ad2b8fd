#pragma once

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// The converged problem seen whole: the touches' information on every arm parameter and every artefact
/// parameter (rows and columns: ArmVector, then the artefact), estimated or not, at the final estimate.
struct Linearisation {
  Eigen::MatrixXd touch_information;
  Eigen::VectorXd touch_gradient;
  std::vector<Eigen::Index> estimated;   // which of its columns were estimated, ascending
  Eigen::MatrixXd estimated_covariance;  // of those, for the declared noise: inverse of the information
};

/// `fit` must have been solved at `estimate`.
Linearisation linearise_whole(const IdentificationOptions& options, LeastSquares& fit,
                              const Estimate& estimate);

/// Nothing without a declared noise or without a degree of freedom.
std::optional<LackOfFit> lack_of_fit(const IdentificationProblem& problem, LeastSquares& fit,
                                     const Estimate& estimate);

/// The residuals over the degrees of freedom, metres; nothing without any.
std::optional<double> estimated_noise_m(const LeastSquares& fit, const Estimate& estimate);

/// Covariances by propagation: of touches, of everything that is known with an uncertainty only, and of what
/// the touches do not see, each through the gain of the fit that was made.
Certainty certainty(const IdentificationProblem& problem, const IdentificationOptions& options,
                    const IdentifiableSet& identifiable, const LeastSquares& fit, const Linearisation& whole,
                    const Estimate& estimate, const std::optional<LackOfFit>& misfit);

}  // namespace calib
