#include "calib_core/uncertainty/distance_uncertainty.hpp"

#include <cmath>

namespace calib {

double mean_distance_std_m(const IdentificationProblem& problem, const LeastSquares& fit,
                           const FullLinearisation& whole, const UncertaintyBudget& budget,
                           const Estimate& estimate, const std::vector<std::size_t>& touches) {
  // Metres, whatever the formulation of the fit.
  LeastSquares distances(problem, {.formulation = Formulation::kSignedDistance}, whole.columns, touches);
  distances.set_rows(estimate);
  const auto& factors = distances.noise_factors();  // the mean distance counts all touches alike
  const Eigen::MatrixXd rows = factors.asDiagonal() * distances.rows();
  const Eigen::VectorXd of_columns = distances.noise_unit_m() * rows.colwise().mean().transpose();
  Eigen::VectorXd mean_row = Eigen::VectorXd::Zero(budget.left_out.rows());
  for (Eigen::Index k = 0; k < of_columns.size(); ++k) mean_row[whole.position_of(k)] = of_columns[k];

  const Eigen::VectorXd carried = whole.estimated_covariance * mean_row(whole.estimated);
  const double ratio = budget.noise_m / fit.noise_unit_m();
  const double of_touches = ratio * ratio * carried.dot(fit.gradient_covariance() * carried);
  const double of_priors = carried.dot((fit.information() - fit.touch_information()) * carried);
  const double of_left_out = (budget.left_out.transpose() * mean_row).squaredNorm();
  double of_lag = 0.0;  // displaces these touches, and bends the estimate in the same run the other way
  if (budget.lagged.cols() > 0) {
    const Eigen::MatrixXd displaced = factors.asDiagonal() * lag_displacements(problem, distances, estimate);
    const Eigen::VectorXd mean_displacement =
        distances.noise_unit_m() * displaced.colwise().mean().transpose();
    of_lag = (mean_displacement.cwiseProduct(problem.gear_lag_std_rad) - budget.lagged.transpose() * mean_row)
                 .squaredNorm();
  }
  const double of_noise =
      budget.noise_m * budget.noise_m * factors.cwiseAbs2().mean() / static_cast<double>(touches.size());
  return std::sqrt(of_noise + of_touches + of_priors + of_left_out + of_lag);
}

}  // namespace calib
