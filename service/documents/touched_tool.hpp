#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "calib_core/compensation/compensation.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "config/cell.hpp"
#include "service/documents/compensation_document.hpp"

namespace cell {

/// A tool whose tip was touched: where it is on the calibrated arm, in place of where the cell's file has it.
struct TouchedTool {
  std::string from;  // where the result is from, for people: "run 12"
  std::string arm;   // its name
  std::string tool;
  Eigen::Vector3d drawn_m = Eigen::Vector3d::Zero();     // in R_6, by the cell's file then
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // in R_6
  /// Of the arm with this tool, beside those of its calibration.
  calib::ArmVector arm_errors = calib::ArmVector::Zero();
  double std_m = 0.0;  // of the tip in the controller's world, root mean square over the workspace box
};

/// Of the result of a run. Why not, in one sentence with the remedy: it is no result of a tool, or it was not
/// accepted. DocumentError when the text is no document.
std::variant<TouchedTool, std::string> touched_tool_of(const std::string& from, std::string_view result_json);

/// Why the tool does not count for the arm of run `applied`, where its run is of `of_run` in the same daemon;
/// the result itself has the number of the daemon that made it. Nothing when it counts.
std::optional<std::string> why_other_calibration(const TouchedTool& touched,
                                                 const std::optional<std::string>& of_run,
                                                 const std::string& applied);

/// ConfigError, which names where the result is from, unless it can be of this cell's arm and its tool of
/// today.
void demand_tool_of(const Cell& cell, const TouchedTool& touched);

/// The tool with its tip where it was touched on the arm that is with_tool(). It points where the drawing
/// says.
calib::CompensationTool as_touched(const calib::CompensationTool& drawn, const TouchedTool& touched);
/// The calibrated arm as it is for this tool, and for no other.
calib::KinematicModel with_tool(const calib::KinematicModel& calibrated, const TouchedTool& touched);

/// What is told of it beside the corrected targets.
CompensationDocument::Touched told_of(const TouchedTool& touched);

}  // namespace cell
