#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "calib_core/estimation/estimate.hpp"
#include "calib_core/estimation/identification_problem.hpp"
#include "calib_core/kinematics/posture_lanes.hpp"
#include "calib_core/numerics/condition_number.hpp"

namespace calib {

/// Reciprocal prior variance of each unknown; 0 where it has no prior.
Eigen::VectorXd prior_precision(const IdentificationProblem& problem, const std::vector<int>& arm_columns,
                                bool with_tolerances);

/// Whether touches are weighed against something else by their noise: given quantities or the maker's
/// figures.
bool has_priors(const IdentificationProblem& problem, const IdentificationOptions& options);

/// Inverse of a positive definite information matrix: the covariance. See ScaledCholesky.
Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& information);

/// The weighted least squares problem of an identification. Its buffers are reused from one iteration to the
/// next. The unknowns are the given columns of the arm (indices into ArmVector), then all artefact
/// parameters. Rows are divided by the declared noise (by 1 m when none is declared), by the noise_factor()
/// of their touch, and weighted by the formulation.
class LeastSquares {
 public:
  /// `touches` are indices into the touches of the problem; all are kept initially. Keeps a reference to the
  /// problem.
  LeastSquares(const IdentificationProblem& problem, const IdentificationOptions& options,
               std::vector<int> arm_columns, std::vector<std::size_t> touches);

  /// The same touches and selection with other columns of the arm.
  LeastSquares(const LeastSquares& other, const IdentificationOptions& options, std::vector<int> arm_columns);

  /// Selects the touches that are fitted. The others still have rows and residuals.
  void keep(const std::vector<bool>& kept);

  void linearise(const Estimate& estimate);

  /// Rows and residuals only, of all touches; solve() needs linearise().
  void set_rows(const Estimate& estimate);

  /// Computes the step to the minimum of the linearised problem; false when it has no unique minimum.
  bool solve();
  [[nodiscard]] const Eigen::VectorXd& step() const { return normal_.step; }
  [[nodiscard]] Estimate stepped(Estimate from) const;  // from + step
  [[nodiscard]] double arm_step_norm() const { return normal_.step.head(arm_count()).norm(); }

  [[nodiscard]] Eigen::Index arm_count() const { return static_cast<Eigen::Index>(arm_columns_.size()); }
  [[nodiscard]] Eigen::Index unknown_count() const { return normal_.step.size(); }
  [[nodiscard]] const std::vector<int>& arm_columns() const { return arm_columns_; }
  [[nodiscard]] const std::vector<std::size_t>& touches() const { return touches_; }
  [[nodiscard]] const std::vector<bool>& kept() const { return kept_; }
  [[nodiscard]] int kept_count() const { return kept_count_; }

  /// Signed distances from the estimated planes, metres, one per touch.
  [[nodiscard]] const Eigen::VectorXd& residuals_m() const { return rows_.residuals_m; }
  [[nodiscard]] double residual_rms_m() const;  // of the kept touches
  /// The weighted rows: one per touch, one column per unknown.
  [[nodiscard]] const Eigen::MatrixXd& rows() const { return rows_.all; }
  [[nodiscard]] const Eigen::VectorXd& weighted_residuals() const { return rows_.weighted_residuals; }
  [[nodiscard]] Eigen::VectorXd weighted_targets() const { return -rows_.weighted_residuals; }
  [[nodiscard]] const Eigen::VectorXd& weights() const { return weights_; }  // of the rows, 1/m
  [[nodiscard]] double noise_unit_m() const { return noise_unit_m_; }
  [[nodiscard]] const Eigen::VectorXd& noise_factors() const { return noise_factors_; }  // of the rows

  /// rows^T rows of the kept touches, without and with the priors.
  [[nodiscard]] const Eigen::MatrixXd& touch_information() const { return normal_.touch_information; }
  [[nodiscard]] const Eigen::MatrixXd& information() const { return normal_.information; }
  /// rows^T (-weighted residuals) of the kept touches.
  [[nodiscard]] const Eigen::VectorXd& touch_gradient() const { return normal_.touch_gradient; }
  /// Covariance of touch_gradient() for noise of one unit. Equals touch_information() except for eq. 6.
  [[nodiscard]] Eigen::MatrixXd gradient_covariance() const;
  /// Sum of squares of the kept weighted residuals: for eq. 6 in its weights, those of the fit.
  [[nodiscard]] double weighted_square_sum() const;
  /// That sum, and those of priors and equations, each divided by its standard deviation.
  [[nodiscard]] double chi_square(const Estimate& estimate) const;
  /// Number of terms of that sum minus number of unknowns.
  [[nodiscard]] int degrees_of_freedom() const;
  /// After solve(): the leverage of each touch, the fraction of its variance that the fit absorbs; for
  /// weights of unit noise.
  const Eigen::VectorXd& leverages();

  /// Condition numbers of the kept rows in these columns of the arm; `positions` are indices into
  /// arm_columns().
  ConditionNumbers condition_numbers(const std::vector<Eigen::Index>& positions);

 private:
  struct Rows {
    Eigen::MatrixXd all, kept;
    Eigen::VectorXd residuals_m, weighted_residuals;
  };
  struct NormalEquations {
    Eigen::MatrixXd touch_information, information, scaled;
    Eigen::VectorXd touch_gradient, gradient, column_scale, step, leverages;
    Eigen::LLT<Eigen::MatrixXd> cholesky;
  };
  void allocate_buffers();
  void set_weights(Formulation formulation);
  void fill_rows(std::size_t block, const PreparedModel& model);
  void add_priors(const Estimate& estimate);

  const IdentificationProblem& problem_;
  std::vector<int> arm_columns_;
  std::vector<std::size_t> touches_;
  std::vector<bool> kept_;
  int kept_count_ = 0;
  bool unit_columns_ = true;
  bool weights_differ_ = false;
  double noise_unit_m_ = 1.0;
  Eigen::VectorXd noise_factors_;       // one per row
  Eigen::VectorXd weights_;             // one per row, 1/m
  Eigen::VectorXd precision_;           // of the priors
  std::vector<PostureLanes> postures_;  // of the touches; the last one fills up its block
  std::vector<ContactSurface> planes_;  // estimated; normals of planes of unit length to first order
  Rows rows_;
  NormalEquations normal_;
  Eigen::MatrixXd information_of_positions_;
  InformationConditions information_conditions_;
};

}  // namespace calib
