#pragma once

#include <vector>

#include "calib_core/estimation/gauss_newton.hpp"

namespace calib {

/// Finds the touches that are inconsistent with the others. run() leaves the consistent ones kept in the fit.
class OutlierRejection {
 public:
  OutlierRejection(const IdentificationProblem& problem, LeastSquares& fit, GaussNewton& iteration)
      : known_noise_(problem.touch_noise_m > 0.0), fit_(fit), iteration_(iteration) {}

  /// Whether the declared noise explains the residuals of the current fit.
  [[nodiscard]] bool is_consistent();

  void run(const std::vector<int>& identifiable);

 private:
  /// A robust start: least trimmed squares of the problem linearised at the nominal arm, then once more at
  /// the resulting arm. Returns the half of the touches that agrees best.
  std::vector<bool> start(const std::vector<int>& identifiable, Estimate& estimate);

  /// Whether each residual is compatible with the noise.
  std::vector<bool> find_inliers(const Estimate& estimate);

  bool known_noise_;
  LeastSquares& fit_;
  GaussNewton& iteration_;
};

}  // namespace calib
