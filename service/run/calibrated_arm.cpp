#include "service/run/calibrated_arm.hpp"

#include "config/arm_writer.hpp"

namespace cell {

std::string calibrated_arm_document(const Cell& cell, const calib::IdentificationResult& result) {
  Arm arm = cell.arm;
  arm.model = result.calibrated;
  return arm_document(arm);
}

}  // namespace cell
