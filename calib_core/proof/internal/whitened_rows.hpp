#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace calib {

/// Distances of touches with a known covariance, freed of what may be of any size: what is left of them has
/// unit variance in each of `degrees()` directions where nothing else is in them.
class WhitenedRows {
 public:
  /// `covariance`: positive definite, square metres. `free`: a column for each quantity of unknown size, a
  /// row per touch; dependent columns count once. Throws std::logic_error for a covariance that is not
  /// positive definite.
  WhitenedRows(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& free);

  /// What is left of the columns, metres in.
  [[nodiscard]] Eigen::MatrixXd rest(const Eigen::MatrixXd& columns) const;
  /// Directions that the free quantities leave.
  [[nodiscard]] Eigen::Index degrees() const { return basis_.rows() - basis_.cols(); }

 private:
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
  Eigen::MatrixXd basis_;  // of the free quantities, whitened
};

/// How likely chance makes a sum of squares of a rest so large, where the noise that whitened it was measured
/// with so many degrees of freedom; infinite ones where it was declared.
double rest_p(double chi_square, double degrees, double noise_degrees);

}  // namespace calib
