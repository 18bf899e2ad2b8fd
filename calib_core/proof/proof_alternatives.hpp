#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib_core/proof/calibration_record.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"

namespace calib {

/// Something that an arm may do and the calibrated model does not have.
struct ProofAlternative {
  std::string name;  // "droop", "eccentric gears", "oval gears"
  /// True minus estimated unknowns of the record, a column for each effect that it is made of, by one
  /// standard deviation: the maker's ones, all multiplied alike.
  Eigen::MatrixXd displacements;
};

/// What a proof should be able to see: a tip error of this size over the workspace box, root mean square.
inline constexpr double kProofWorthMetres = 0.1e-3;

/// The alternatives that the arm's file gives deviations for and that were not estimated: a droop of joints
/// 1 to 3 together, eccentric gears (first harmonics), oval ones (second harmonics). Each is as large as
/// makes the calibrated tip wrong by `worth_m`, root mean square over `region`: the part that the calibration
/// absorbs does not count.
std::vector<ProofAlternative> proof_alternatives(const CalibrationRecord& record, const TipRegion& region,
                                                 double worth_m = kProofWorthMetres);

}  // namespace calib
