#include "service/run/calibrated_arm.hpp"

#include <optional>

#include "calib_core/uncertainty/uncertainty_budget.hpp"
#include "config/arm_writer.hpp"

namespace cell {

namespace {

/// Nothing where an error of any size is possible, but for those of the block's place.
std::optional<calib::ArmCovariance> covariance_in_arm_frame(const calib::IdentificationResult& result) {
  if (!result.uncertainty) return std::nullopt;
  const calib::UncertaintyBudget of_arm = calib::in_arm_frame(*result.uncertainty);
  if (!of_arm.unknown_directions.isZero()) return std::nullopt;
  calib::ArmCovariance covariance = of_arm.covariance();
  if (!covariance.allFinite()) return std::nullopt;
  return covariance;
}

}  // namespace

std::string calibrated_arm_document(const Cell& cell, const calib::IdentificationResult& result) {
  Arm arm = cell.arm;
  if (cell.arm_serial) arm.serial = cell.arm_serial;
  arm.model = result.calibrated;
  arm.covariance = covariance_in_arm_frame(result);
  return arm_document(arm);
}

}  // namespace cell
