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
  double of_patterns = 0.0;  // they displace these touches, and bend the estimate in the same run
  if (!whole.patterns.empty()) {
    const Eigen::MatrixXd displaced =
        factors.asDiagonal() * pattern_displacements(problem, distances, estimate);
    Eigen::VectorXd by_one_std = budget.patterned.transpose() * mean_row;
    for (Eigen::Index k = 0; k < by_one_std.size(); ++k) {
      by_one_std[k] += whole.patterns[static_cast<std::size_t>(k)].std * distances.noise_unit_m() *
                       displaced.col(k).mean();
    }
    of_patterns = by_one_std.squaredNorm();
  }
  const double of_noise =
      budget.noise_m * budget.noise_m * factors.cwiseAbs2().mean() / static_cast<double>(touches.size());
  return std::sqrt(of_noise + of_touches + of_priors + of_left_out + of_patterns);
}

}  // namespace calib
