#pragma once

#include <Eigen/Core>
#include <iterator>
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

  /// From here on touches are held against the artefact as warm as it is now: its surfaces there. One for
  /// each face; std::logic_error for another number.
  void meet_at(std::vector<ContactSurface> contact_planes);

  /// As it was fitted: artefact (but for meet_at()), priors, the noise that weighed the touches; without
  /// touches.
  [[nodiscard]] const IdentificationProblem& problem() const { return problem_; }
  [[nodiscard]] const IdentificationOptions& options() const { return options_; }
  [[nodiscard]] const KinematicModel& calibrated() const { return calibrated_; }
  [[nodiscard]] const ArmVector& errors() const { return errors_; }  // 0 of what was not estimated
  [[nodiscard]] const Eigen::VectorXd& artefact_errors() const { return artefact_errors_; }
  /// Of a fitted touch, mean over them: measured by the residuals or expected, the smaller one. Residuals are
  /// larger where the model lacks something, and a test against them would be blind to what it lacks.
  /// Expected is what repeats and the maker's figures of the ripple make. The stops are in the repeats, and
  /// the play is among the patterns, so that their figures do not count again.
  [[nodiscard]] const TouchNoise& noise() const { return noise_; }
  /// Of the distance of any touch, square metres. `per_rad`: how it changes with the position of each joint,
  /// metres per radian; `factor`: noise_factor() of the touch.
  ///
  /// An error of a joint displaces the ball by its lever about that joint's axis, so that a touch with the
  /// arm stretched out scatters more than one near the base; what the probe does is alike for all. With the
  /// maker's figures g_j of ripple and stops, levers l_ij and G the mean of sum_j (l_ij g_j)^2 over the
  /// fitted touches, touch i has of the measured variance s^2 the part 1 - q + q sum_j (l_ij g_j)^2 / G,
  /// whose mean over the fitted touches is 1. q is at most what the figures explain, min(1, G / s^2), and of
  /// that the share that the residuals of the fit show: its mean after them, any share alike before.
  [[nodiscard]] double noise_variance_m2(const JointVector& per_rad, double factor) const;
  [[nodiscard]] Eigen::Index unknown_count() const {
    return whole_.touch_information.rows() + std::ssize(whole_.patterns);
  }

  /// Of the unknowns while the model is complete: by noise (of each touch as its levers make it) and priors
  /// of what was estimated, by the maker's tolerances of the kinematic errors that were not, by the patterns.
  /// What is beside rigid kinematics and was not estimated is not in it: whether it is there is what touches
  /// that were never fitted are to tell.
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return covariance_; }

  /// How the estimated unknowns would scatter if the same calibration were made again: by noise alone.
  [[nodiscard]] const Eigen::MatrixXd& scatter() const { return scatter_; }
  /// True minus estimated unknowns by one standard deviation of each unknown that has one, estimated or not,
  /// a column each: what a calibration at the same postures would do again. A column of 0 where none is
  /// given. Of the errors of a block whose faces and lengths are told each has its own: no smaller than they
  /// are.
  [[nodiscard]] Eigen::MatrixXd repeated_displacements() const;

  /// Columns of the arm (indices into ArmVector) that were linearised: the candidates, and what else was
  /// estimated or has a deviation.
  [[nodiscard]] const std::vector<int>& known_columns() const { return whole_.columns; }
  [[nodiscard]] bool is_estimated(int arm_column) const;
  /// True minus estimated unknowns when the true arm has one unit of this error (index into ArmVector), which
  /// was not estimated: the error itself, and how it bent the estimate.
  [[nodiscard]] Eigen::VectorXd displacement_by(int arm_column) const;

  /// True minus estimated unknowns, when the arm grew evenly by one unit (a share of its lengths) from the
  /// first to the last fitted touch, in the order of the problem: against the arm as it was in the middle.
  [[nodiscard]] const Eigen::VectorXd& displacement_by_growth() const { return bent_by_growth_; }

 private:
  [[nodiscard]] Eigen::VectorXd displacement_by_pattern(Eigen::Index pattern) const;  // by its deviation
  [[nodiscard]] Eigen::VectorXd bent_by(const Eigen::VectorXd& of_columns) const;
  void share_noise(const JointVector& gear_variances, const Eigen::MatrixXd& per_rad, LeastSquares& fit);
  [[nodiscard]] Eigen::MatrixXd joint_covariance(const Eigen::MatrixXd& of_noise) const;

  IdentificationProblem problem_;
  IdentificationOptions options_;
  KinematicModel calibrated_;
  ArmVector errors_;
  Eigen::VectorXd artefact_errors_;
  TouchNoise noise_;
  double alike_variance_m2_ = 0.0;  // of the noise, what does not grow with the levers
  JointVector joint_variances_rad2_ = JointVector::Zero();  // ... and what does
  FullLinearisation whole_;
  Eigen::VectorXd bent_by_growth_;
  Eigen::MatrixXd scatter_;
  Eigen::MatrixXd covariance_;
};

}  // namespace calib
