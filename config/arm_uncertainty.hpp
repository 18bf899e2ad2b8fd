#pragma once

#include <string>

#include "calib_core/uncertainty/uncertainty_budget.hpp"
#include "config/json_value.hpp"

/// "uncertainty" of an arm's file: what a calibration leaves open of the arm in its own frame.
namespace cell {

/// Covariance of the errors of an arm, true minus as written, as in_arm_frame() has it. ConfigError where it
/// names an error twice or one that no arm has, and where it is no covariance: then a tip could be told more
/// certain than it is.
calib::ArmCovariance arm_covariance_from_json(const JsonValue& value);

/// The same as JSON text: the names of the errors that are not certain and the lower triangle of their
/// covariance, a row a line, to nine digits. All figures must be finite.
std::string arm_covariance_text(const calib::ArmCovariance& covariance);

}  // namespace cell
