#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib_core/estimation/goodness_of_fit.hpp"
#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/uncertainty/left_out_effects.hpp"
#include "calib_core/uncertainty/touch_patterns.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"

namespace calib {

/// The linearisation of the converged problem in all parameters, estimated or not: information of the touches
/// on arm and artefact (rows and columns: ArmVector, then the artefact parameters) at the final estimate.
struct FullLinearisation {
  std::vector<int> columns;  // of the arm, those that were linearised
  Eigen::MatrixXd touch_information;
  Eigen::VectorXd touch_gradient;
  /// What the residuals say of the noise, in units of the fit's; nothing of touches that are only planned:
  /// they say nothing of what was left out either.
  std::optional<NoiseEvidence> noise;
  /// What displaces the touches by a pattern: each a further column of the linearisation, with its
  /// information with the columns above (a column each), with the other patterns, and its gradient. Empty
  /// without any.
  std::vector<TouchPattern> patterns;
  Eigen::MatrixXd pattern_columns;
  Eigen::MatrixXd pattern_information;
  Eigen::VectorXd pattern_gradient;
  std::vector<Eigen::Index> estimated;  // the estimated columns, ascending
  Eigen::MatrixXd
      estimated_covariance;  // of these columns, for the declared noise: inverse of the information

  /// Where column k of a linearisation in `columns` and all artefact parameters stands in these matrices.
  [[nodiscard]] Eigen::Index position_of(Eigen::Index k) const {
    const auto count = static_cast<Eigen::Index>(columns.size());
    return k < count ? columns[static_cast<std::size_t>(k)] : kArmParameterCount + k - count;
  }
};

/// One standard deviation of each joint's error that changes from posture to posture beside these estimated
/// parameters of the arm: without the ripples among them. Radians.
JointVector gear_std_beside(const IdentificationProblem& problem, const std::vector<int>& arm_columns);

/// Standard deviation with which the budget counts a parameter of the arm (index into ArmVector) that is not
/// estimated; nothing where it is unknown, and of a ripple, which is an error of posture then.
std::optional<double> std_unless_estimated(const IdentificationProblem& problem, int column,
                                           const HarmonicShares& shares);

/// `fit` must have been solved at `estimate`; `covariance`: the inverse of its information, computed when
/// missing.
FullLinearisation linearise_all_parameters(const IdentificationProblem& problem,
                                           const IdentificationOptions& options, LeastSquares& fit,
                                           const Estimate& estimate,
                                           std::optional<Eigen::MatrixXd> covariance = {});

/// The share of the budget that the fit has: this noise of the touches and the uncertainty of everything that
/// has a prior. `covariance`: the inverse of fit.information().
UncertaintyBudget fitted_uncertainty(const IdentificationProblem& problem,
                                     const IdentificationOptions& options, const LeastSquares& fit,
                                     const Eigen::MatrixXd& covariance, const TouchNoise& noise);

/// Adds to fitted_uncertainty(), with the gear share that it has, the errors that the touches do not
/// determine and what was left out.
void add_unfitted(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                  const LeastSquares& fit, const FullLinearisation& whole, UncertaintyBudget& fitted);

/// Both: propagates through the gain of the fit this noise of the touches, the uncertainty of everything that
/// has a prior, and the errors that the touches do not determine.
UncertaintyBudget propagate_uncertainty(const IdentificationProblem& problem,
                                        const IdentificationOptions& options,
                                        const IdentifiableSet& identifiable, const LeastSquares& fit,
                                        const FullLinearisation& whole, const TouchNoise& noise);

}  // namespace calib
