#include "calib_core/proof/calibration_record.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/model_selection.hpp"

namespace calib {
namespace {

std::vector<std::size_t> fitted_touches(const IdentificationProblem& problem,
                                        const IdentificationResult& result) {
  std::vector<std::size_t> fitted;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const bool is_rejected =
        std::ranges::find(result.rejected, i, &RejectedTouch::touch) != result.rejected.end();
    if (problem.touches[i].role == TouchRole::kFit && !is_rejected) fitted.push_back(i);
  }
  return fitted;
}

}  // namespace

CalibrationRecord::CalibrationRecord(const IdentificationProblem& problem,
                                     const IdentificationOptions& options, const IdentificationResult& result)
    : problem_(problem),
      options_(settled_options(options, result)),
      calibrated_(result.calibrated),
      artefact_errors_(result.artefact_errors) {
  if (result.status != IdentificationStatus::kConverged || !result.uncertainty)
    throw std::logic_error("only a calibration that has converged can be proved or checked");
  noise_ = {result.uncertainty->noise_m, result.uncertainty->degrees_of_freedom};
  if (const auto& expected = result.lack_of_fit; expected && expected->noise_m < noise_.std_m)
    noise_ = {expected->noise_m, expected->noise_degrees};
  if (result.weight_noise_m > 0.0) assume_noise(problem_, result.weight_noise_m);
  LeastSquares fit(problem_, options_, estimated_columns(problem_, options_, result.identifiable),
                   fitted_touches(problem, result));
  const Estimate estimate{result.errors, result.artefact_errors};
  fit.linearise(estimate);
  if (!fit.solve()) throw std::logic_error("the touches of the calibration do not determine its result");
  whole_ = linearise_all_parameters(problem_, options_, fit, estimate);
  covariance_ = joint_covariance(noise_.std_m / fit.noise_unit_m());
  problem_.touches.clear();
}

bool CalibrationRecord::is_estimated(int arm_column) const {
  return std::ranges::binary_search(whole_.estimated, arm_column);
}

Eigen::VectorXd CalibrationRecord::bent_by(const Eigen::VectorXd& of_columns) const {
  Eigen::VectorXd bent = Eigen::VectorXd::Zero(whole_.touch_information.rows() + std::ssize(whole_.patterns));
  bent(whole_.estimated) = -whole_.estimated_covariance * of_columns(whole_.estimated);
  return bent;
}

Eigen::VectorXd CalibrationRecord::displacement_by(int arm_column) const {
  Eigen::VectorXd displaced = bent_by(whole_.touch_information.col(arm_column));
  displaced[arm_column] += 1.0;
  return displaced;
}

Eigen::MatrixXd CalibrationRecord::joint_covariance(double noise_ratio) const {
  const Eigen::Index unknowns = whole_.touch_information.rows() + std::ssize(whole_.patterns);
  const Eigen::MatrixXd& weighted = whole_.estimated_covariance;
  // The noise may differ from the one that weighed the touches against the priors.
  const Eigen::MatrixXd of_unit_noise =
      weighted * whole_.touch_information(whole_.estimated, whole_.estimated) * weighted;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(unknowns, unknowns);
  covariance(whole_.estimated, whole_.estimated) =
      weighted + (noise_ratio * noise_ratio - 1.0) * of_unit_noise;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    const auto& tolerance = problem_.tolerances[static_cast<std::size_t>(column)];
    if (!tolerance || is_estimated(column)) continue;
    const Eigen::VectorXd displaced = *tolerance * displacement_by(column);
    covariance += displaced * displaced.transpose();
  }
  for (Eigen::Index k = 0; k < std::ssize(whole_.patterns); ++k) {
    Eigen::VectorXd displaced = bent_by(whole_.pattern_columns.col(k));
    displaced[whole_.touch_information.rows() + k] = 1.0;
    displaced *= whole_.patterns[static_cast<std::size_t>(k)].std;
    covariance += displaced * displaced.transpose();
  }
  return covariance;
}

}  // namespace calib
