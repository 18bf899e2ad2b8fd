#pragma once

#include <string>

#include "config/cell.hpp"

namespace cell {

/// The arm as a document of schema touchcal/arm/5, or /4 without a serial number, that read_arm() takes for
/// the same arm: angles exactly, lengths to the last bit of a double (1e-16 m for an arm of metres), a
/// covariance to nine digits. All figures must be finite.
std::string arm_document(const Arm& arm);

}  // namespace cell
