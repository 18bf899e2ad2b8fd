#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "calib_core/kinematics/error_parameters.hpp"

namespace calib {

/// What the observation matrix determines of a candidate.
enum class ParameterStatus {
  kIdentified,
  kGrouped,   // its column is a combination of identified columns, which absorb its effect
  kNoEffect,  // its column is zero
  kExcluded,  // by the options
  kWeak,      // independent, but below the tolerance or too weak for the declared noise
};

struct IdentifiabilityOptions {
  std::optional<double> qr_tolerance;  // on |R_ii|; eq. 13 when absent
  std::vector<int> tried_last;         // candidates moved to the end of the column order, in this order
  std::vector<int> excluded;           // candidates that are never identified
};

/// |R_ii| up to which a candidate is weak, one per candidate; 0 disables the limit.
using WeakDiagonals = std::array<double, kErrorParameterCount>;

/// Status of a candidate. For a grouped one: identified parameters, and leading columns by their index, that
/// absorb it, with the change of each per unit of the candidate (SI units).
struct CandidateStatus {
  ParameterStatus status = ParameterStatus::kNoEffect;
  std::vector<std::pair<int, double>> grouped_with;
  std::vector<std::pair<int, double>> grouped_with_leading;
};

struct IdentifiableSet {
  std::vector<int> columns;  // identified candidates, ascending
  std::array<CandidateStatus, kErrorParameterCount> candidates;
  double smallest_kept = 0.0;    // |R_ii|
  double largest_dropped = 0.0;  // |R_ii|; a wide gap to smallest_kept makes the choice clear
};

/// Chooses the identifiable columns by QR without pivoting in the given column order (eq. 12 to 14). A column
/// with |R_ii| below the tolerance depends on the previous ones and is left out of the remaining
/// decomposition. W should be that of the nominal model with each touch on its nominal face. `leading`
/// columns (same number of rows) come before all candidates: faces that are estimated in place and explain
/// part of W.
IdentifiableSet choose_identifiable(const Eigen::Ref<const Eigen::MatrixXd>& observation_matrix,
                                    const IdentifiabilityOptions& options,
                                    const WeakDiagonals& weak_diagonals = {},
                                    const Eigen::MatrixXd& leading = {});

/// Columns of a matrix by index.
Eigen::MatrixXd select_columns(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                               const std::vector<int>& columns);

}  // namespace calib
