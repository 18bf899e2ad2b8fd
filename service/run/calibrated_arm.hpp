#pragma once

#include <string>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"

namespace cell {

/// The cell's arm with the identified errors in its frames (and compliances, if estimated) and the maker's
/// values elsewhere: a file of schema touchcal/arm/5 that reads back to result.calibrated.
std::string calibrated_arm_document(const Cell& cell, const calib::IdentificationResult& result);

}  // namespace cell
