#pragma once

#include <vector>

#include "calib_core/estimation/gauss_newton.hpp"

namespace calib {

/// Which touches belong together. Ends with the kept ones set in the fit, and converged or not.
class RobustSearch {
 public:
  RobustSearch(const IdentificationProblem& problem, LeastSquares& fit, Iterations& iterations)
      : known_noise_(problem.touch_noise_m > 0.0), fit_(fit), iterations_(iterations) {}

  /// Whether the declared noise explains the residuals of the fit at hand.
  [[nodiscard]] bool nothing_suspect();

  void run(const std::vector<int>& identifiable);

 private:
  /// A high-breakdown start: least trimmed squares of the problem linearised at the nominal arm, then
  /// concentrated once more where that leads.
  std::vector<bool> start(const std::vector<int>& identifiable, Estimate& estimate);

  /// The touches whose residuals a good touch could have.
  std::vector<bool> judged(const Estimate& estimate);

  bool known_noise_;
  LeastSquares& fit_;
  Iterations& iterations_;
};

}  // namespace calib
