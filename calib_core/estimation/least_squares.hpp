#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <vector>

#include "calib_core/identification/identify.hpp"

namespace calib {

/// Where the iteration stands: errors of the arm (0 where not estimated) and of the artefact.
struct Estimate {
  ArmVector arm = ArmVector::Zero();
  Eigen::VectorXd artefact;
};

/// What one standard deviation says of one unknown; precision 0 says nothing.
Eigen::VectorXd prior_precision(const IdentificationProblem& problem, const std::vector<int>& arm_columns,
                                bool with_tolerances);

/// Inverse of an information matrix, positive definite; its rows of different units are scaled for the
/// digits.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& information);

/// The weighted least squares problem behind an identification, and the memory its iterations use. The
/// unknowns are the given columns of the arm (indices into ArmVector), then every artefact parameter. Rows
/// are divided by the declared noise (by 1 m when none is declared); in the formulation of eq. 6 they are
/// weighted as there.
class LeastSquares {
 public:
  /// `touches` are indices into the problem's; all are kept at first. The problem must outlive this.
  LeastSquares(const IdentificationProblem& problem, const IdentificationOptions& options,
               std::vector<int> arm_columns, std::vector<std::size_t> touches);

  /// The same touches, kept or not, with other columns of the arm.
  LeastSquares(const LeastSquares& other, const IdentificationOptions& options, std::vector<int> arm_columns);

  /// Touches that are not kept have rows and residuals, but no say.
  void keep(const std::vector<bool>& kept);

  void linearise(const Estimate& estimate);

  /// The step to the minimum of the linearised problem; false when that has none.
  bool solve();
  [[nodiscard]] const Eigen::VectorXd& step() const { return step_; }
  [[nodiscard]] Estimate stepped(Estimate from) const;
  [[nodiscard]] double arm_step_norm() const { return step_.head(arm_count()).norm(); }

  [[nodiscard]] Eigen::Index arm_count() const { return static_cast<Eigen::Index>(arm_columns_.size()); }
  [[nodiscard]] Eigen::Index unknown_count() const { return step_.size(); }
  [[nodiscard]] const std::vector<int>& arm_columns() const { return arm_columns_; }
  [[nodiscard]] const std::vector<std::size_t>& touches() const { return touches_; }
  [[nodiscard]] const std::vector<bool>& kept() const { return kept_; }
  [[nodiscard]] int kept_count() const { return kept_count_; }

  /// Signed distances from the planes as estimated, metres, one a touch.
  [[nodiscard]] const Eigen::VectorXd& residuals_m() const { return residuals_m_; }
  [[nodiscard]] double residual_rms_m() const;  // of the kept touches
  /// The weighted rows, one a touch, one column an unknown.
  [[nodiscard]] const Eigen::MatrixXd& rows() const { return rows_; }
  [[nodiscard]] Eigen::VectorXd weighted_targets() const { return -weighted_residuals_; }
  [[nodiscard]] double noise_unit_m() const { return noise_unit_m_; }

  /// rows^T rows of the kept touches, without and with the prior.
  [[nodiscard]] const Eigen::MatrixXd& touch_information() const { return touch_information_; }
  [[nodiscard]] const Eigen::MatrixXd& information() const { return information_; }
  /// rows^T (-weighted residuals) of the kept touches.
  [[nodiscard]] const Eigen::VectorXd& touch_gradient() const { return touch_gradient_; }
  /// Covariance of the touches' gradient for noise of one unit: their information, but for eq. 6.
  [[nodiscard]] Eigen::MatrixXd gradient_covariance() const;
  /// Kept residuals, priors and equations, each over its standard deviation, squared and summed.
  [[nodiscard]] double chi_square(const Estimate& estimate) const;
  /// Terms of that sum less unknowns.
  [[nodiscard]] int degrees_of_freedom() const;
  /// After solve(): how much of each touch's own variance the fit takes up, for weights of unit noise.
  const Eigen::VectorXd& leverages();

  /// sigma_max / sigma_min (eq. 16) of the touches' rows in these columns of the arm, and after columns of
  /// unit norm. `positions` index arm_columns().
  struct Conditions {
    double condition_number = 0.0;
    double scaled_condition_number = 0.0;
  };
  Conditions conditions(const std::vector<Eigen::Index>& positions);

 private:
  void size_memory();
  void set_weights(Formulation formulation);
  void fill_row(Eigen::Index row, const PreparedModel& model);
  void add_priors(const Estimate& estimate);
  double extreme_ratio(const Eigen::MatrixXd& gram);

  const IdentificationProblem& problem_;
  std::vector<int> arm_columns_;
  std::vector<std::size_t> touches_;
  std::vector<bool> kept_;
  int kept_count_ = 0;
  bool unit_columns_ = true;
  bool weights_differ_ = false;
  double noise_unit_m_ = 1.0;
  Eigen::VectorXd weights_;             // of a row, 1/m
  Eigen::VectorXd precision_;           // of the unknowns' priors
  std::vector<PreparedJoints> joints_;  // one a touch
  std::vector<Plane> planes_;           // contact planes as estimated; normals not of unit length when tilted
  Eigen::MatrixXd rows_, kept_rows_;
  Eigen::VectorXd residuals_m_, weighted_residuals_;
  Eigen::MatrixXd touch_information_, information_, scaled_;
  Eigen::VectorXd touch_gradient_, gradient_, column_scale_, step_, leverages_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
  Eigen::MatrixXd gram_, unit_gram_;
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen_;
};

}  // namespace calib
