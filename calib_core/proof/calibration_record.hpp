#pragma once

#include <Eigen/Core>
#include <vector>

#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/identification/identification_result.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {

/// What a converged identification knows, and what it leaves open, of the arm, the artefact and the patterns
/// of touches together: what touches that were never fitted are judged against.
///
/// The unknowns are the ArmVector, the artefact parameters and touch_patterns(), in SI units; their errors
/// are true minus estimated. Arm and artefact are not told apart here, as the same block and ball are touched
/// again: an error that they share with the calibration does not show.
class CalibrationRecord {
 public:
  /// `result` is that of identify() for problem and options, converged, with an uncertainty; else
  /// std::logic_error. Copies what it needs.
  CalibrationRecord(const IdentificationProblem& problem, const IdentificationOptions& options,
                    const IdentificationResult& result);

  /// As it was fitted: artefact, priors, the noise that weighed the touches; without touches.
  [[nodiscard]] const IdentificationProblem& problem() const { return problem_; }
  [[nodiscard]] const IdentificationOptions& options() const { return options_; }
  [[nodiscard]] const KinematicModel& calibrated() const { return calibrated_; }
  [[nodiscard]] const Eigen::VectorXd& artefact_errors() const { return artefact_errors_; }
  /// Of a touch: measured by the residuals or expected by repeats and the maker's figures of the gears, the
  /// smaller one. Residuals are larger where the model lacks something, and a test against them would be
  /// blind to what it lacks.
  [[nodiscard]] const TouchNoise& noise() const { return noise_; }
  [[nodiscard]] Eigen::Index unknown_count() const { return covariance_.rows(); }

  /// Of the unknowns while the model is complete: by noise and priors of what was estimated, by the maker's
  /// tolerances of the kinematic errors that were not, by the patterns. What is beside rigid kinematics and
  /// was not estimated is not in it: whether it is there is what touches that were never fitted are to tell.
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// Columns of the arm (indices into ArmVector) that were linearised: the candidates, and what else was
  /// estimated or has a deviation.
  [[nodiscard]] const std::vector<int>& known_columns() const { return whole_.columns; }
  [[nodiscard]] bool is_estimated(int arm_column) const;
  /// True minus estimated unknowns when the true arm has one unit of this error (index into ArmVector), which
  /// was not estimated: the error itself, and how it bent the estimate.
  [[nodiscard]] Eigen::VectorXd displacement_by(int arm_column) const;

 private:
  [[nodiscard]] Eigen::VectorXd bent_by(const Eigen::VectorXd& of_columns) const;
  [[nodiscard]] Eigen::MatrixXd joint_covariance(double noise_ratio) const;

  IdentificationProblem problem_;
  IdentificationOptions options_;
  KinematicModel calibrated_;
  Eigen::VectorXd artefact_errors_;
  TouchNoise noise_;
  FullLinearisation whole_;
  Eigen::MatrixXd covariance_;
};

}  // namespace calib
