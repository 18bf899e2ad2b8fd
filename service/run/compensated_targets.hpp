#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/compensation/compensation.hpp"
#include "config/cell.hpp"
#include "config/targets_file.hpp"

namespace cell {

/// How far a length or an angle of a calibrated arm may be from the cell's arm: an arm of the same type is
/// within these, another one is not.
inline constexpr double kSameArmMetres = 0.05;
inline constexpr double kSameArmRadians = 0.1;

/// ConfigError, which names `arm_source`, unless `arm` can be a calibration of the cell's arm: the same
/// name, joints and directions, frames 2 to 7 within kSameArm. Frames 0 and 1 are not looked at, as they say
/// where the block stood.
void demand_arm_of(const Cell& cell, const Arm& arm, const std::string& arm_source);

/// ConfigError, which names `arm_source`, where the arm is known to be of another robot than the cell's.
void demand_serial_of(const Cell& cell, const Arm& arm, const std::string& arm_source);

/// Whether the arm has the errors and the compliances of the cell's own: then there is nothing to correct.
bool is_uncalibrated(const Cell& cell, const Arm& arm);

/// The stylus or the tool of the cell of this name; ConfigError with all of them where there is none.
/// `source` and `pointer`: what names the tool.
calib::CompensationTool tool_named(const Cell& cell, const Arm& arm, const std::string& name,
                                   const std::string& source, const std::string& pointer);

/// Of the cell's arm as it was calibrated. The cell has revolute joints only (demand_revolute()) and the arm
/// is one of its own (demand_arm_of()).
calib::Compensation compensation_in(const Cell& cell, const Arm& arm);

/// The targets in their order, each with its uncertainty where the arm has a covariance; how the arm
/// comes to a target is not looked at: straight_line_targets.hpp. `threads`: of the many targets of a file, 1
/// or more; the results do not depend on it.
std::vector<calib::CompensatedTarget> compensated(const calib::Compensation& compensation,
                                                  const calib::CompensationTool& tool,
                                                  const std::vector<Target>& targets, int threads = 1);
/// The same by compensation_in().
std::vector<calib::CompensatedTarget> compensated(const Cell& cell, const Arm& arm,
                                                  const calib::CompensationTool& tool,
                                                  const std::vector<Target>& targets, int threads = 1);

}  // namespace cell
