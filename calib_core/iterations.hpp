#pragma once

#include <string>
#include <vector>

#include "calib_core/least_squares.hpp"

namespace calib {

/// Iterates from an estimate to the minimum over the kept touches. By hand rather than with Ceres: the
/// problem is small and dense with exact derivatives, and the benchmark beside Ceres (tests/benchmark) finds
/// this more than ten times as fast.
class Iterations {
 public:
  /// The conditions are those of the `identifiable` among the fit's columns. All three must outlive this.
  Iterations(const IdentificationProblem& problem, const IdentificationOptions& options, LeastSquares& fit,
             const std::vector<int>& identifiable);

  /// Where every identification starts: the problem's start, and an artefact as it was written down.
  [[nodiscard]] Estimate nominal() const;

  /// Converged, or why not in message(). Leaves the fit linearised and solved at the estimate.
  bool run(Estimate& estimate, bool with_conditions);

  [[nodiscard]] const std::vector<Iteration>& history() const { return history_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] bool solvable() const { return solvable_; }

 private:
  [[nodiscard]] std::string history_text() const;

  const IdentificationProblem& problem_;
  const IdentificationOptions& options_;
  LeastSquares& fit_;
  std::vector<Eigen::Index> positions_;  // of the identifiable among the estimated columns
  std::vector<Iteration> history_;
  std::string message_;
  bool solvable_ = true;
};

}  // namespace calib
