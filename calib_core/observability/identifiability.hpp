#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "calib_core/kinematics/error_parameters.hpp"

namespace calib {

/// What the observation matrix says of a candidate.
enum class ParameterStatus {
  kIdentified,
  kGrouped,   // its column is a combination of identified ones, which carry its effect
  kNoEffect,  // a column of zeros
  kExcluded,  // by the options
  kWeak,      // independent, but under the given tolerance or too weak for the noise
};

struct IdentifiabilityOptions {
  std::optional<double> qr_tolerance;  // on |R_ii|; eq. 13 when absent
  std::vector<int> tried_last;         // candidates moved to the end of the column order, in this order
  std::vector<int> excluded;           // candidates never identified
};

/// |R_ii| up to which a candidate is weak, one a candidate; 0 lets everything through.
using WeakDiagonals = std::array<double, kErrorParameterCount>;

/// Status of a candidate; for a grouped one what one unit of it adds to which identified ones (SI units).
struct CandidateStatus {
  ParameterStatus status = ParameterStatus::kNoEffect;
  std::vector<std::pair<int, double>> grouped_with;
};

struct IdentifiableSet {
  std::vector<int> columns;  // identified candidates, ascending
  std::array<CandidateStatus, kErrorParameterCount> candidates;
  double smallest_kept = 0.0;    // |R_ii|
  double largest_dropped = 0.0;  // |R_ii|: the gap between the two is the certainty of the choice
};

/// QR without pivoting in the wanted column order (eq. 12 to 14): a column whose |R_ii| is under the
/// tolerance depends on the ones before it and is left out of the rest of the decomposition. W is meant to be
/// that of the nominal model with each touch on its nominal face. `leading` columns (as many rows, any
/// number) come before all candidates: faces estimated in place, which take up what they explain.
IdentifiableSet choose_identifiable(const Eigen::Ref<const Eigen::MatrixXd>& observation_matrix,
                                    const IdentifiabilityOptions& options,
                                    const WeakDiagonals& weak_diagonals = {},
                                    const Eigen::MatrixXd& leading = {});

/// Columns of a matrix by index.
Eigen::MatrixXd select_columns(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                               const std::vector<int>& columns);

/// Singular values, descending.
Eigen::VectorXd singular_values(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

/// The `count` largest singular values, descending; quicker where they are not far apart.
Eigen::VectorXd largest_singular_values(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int count);

/// sigma_max / sigma_min (eq. 16); infinite when sigma_min is 0.
double condition_number(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace calib
