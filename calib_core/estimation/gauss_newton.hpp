#pragma once

#include <string>
#include <vector>

#include "calib_core/estimation/least_squares.hpp"

namespace calib {

/// Gauss-Newton iteration of a least squares problem to its minimum over the kept touches. Our own rather
/// than Ceres: the problem is small and dense with exact derivatives, and the benchmark beside Ceres
/// (tests/benchmark) finds this more than ten times as fast.
class GaussNewton {
 public:
  /// Iteration::condition_number is that of the `identifiable` columns of the fit. Keeps references to the
  /// other arguments.
  GaussNewton(const IdentificationProblem& problem, const IdentificationOptions& options, LeastSquares& fit,
              const std::vector<int>& identifiable);

  /// The estimate that every identification starts from: the start of the problem and the nominal artefact.
  [[nodiscard]] Estimate start() const;

  /// Iterates from `estimate`. False when it does not converge; message() says why. On convergence the fit is
  /// linearised and solved at the final estimate but for the last step.
  bool run(Estimate& estimate, bool with_conditions);

  [[nodiscard]] const std::vector<Iteration>& history() const { return history_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] bool solvable() const { return solvable_; }

 private:
  [[nodiscard]] std::string history_text() const;

  const IdentificationProblem& problem_;
  const IdentificationOptions& options_;
  LeastSquares& fit_;
  std::vector<Eigen::Index> positions_;  // of the identifiable columns among the estimated ones
  std::vector<Iteration> history_;
  std::string message_;
  bool solvable_ = true;
};

}  // namespace calib
