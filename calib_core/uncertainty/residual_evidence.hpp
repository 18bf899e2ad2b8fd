#pragma once

#include <optional>
#include <vector>

#include "calib_core/estimation/goodness_of_fit.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

/// What the residuals of a fit can say, and what they do say, of the arm beside the noise of the touches.
namespace calib {

/// Variance of a touch by errors of the joints of this standard deviation (the maker's figures of the gears),
/// mean over these touches of the nominal arm as they are weighed by their noise_factor(), square metres.
double gear_variance_m2(const IdentificationProblem& problem, const JointVector& gear_std_rad,
                        const std::vector<std::size_t>& touches);

/// Score test for the compliance of the joints that have a deviation and were left out, at the converged fit:
/// how much of the residuals their columns would explain beside all that was estimated. Nothing where none
/// was left out, where these touches do not show it beside the rest, or without a degree of freedom.
std::optional<DroopTest> test_droop(const IdentificationProblem& problem, const LeastSquares& fit,
                                    const FullLinearisation& whole, const ResidualSum& residuals);

/// What the touches of a run say of errors that change from posture to posture.
struct GearEvidence {
  TouchNoise residuals;           // of the fit: touches and gears together
  TouchNoise repeats;             // of touches of one place, where the gears err alike
  double gear_variance_m2 = 0.0;  // of a touch by the maker's figures
};

/// The gears' true variance as a share of the maker's: its mean after the touches. Before them the errors of
/// the gears are s times the maker's, s half-normal with E[s^2] = 1, and every magnitude of the touches' own
/// noise is alike. 1 where nothing is known.
double mean_gear_share(const GearEvidence& evidence);

}  // namespace calib
