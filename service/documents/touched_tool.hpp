#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <variant>

#include "calib_core/compensation/compensation.hpp"
#include "service/documents/compensation_document.hpp"

namespace cell {

/// A tool whose tip was touched: where it is on the calibrated arm, in place of where the cell's file has it.
struct TouchedTool {
  std::string from;  // where the result is from, for people: "run 12"
  std::string tool;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // in R_6
  double std_m = 0.0;  // root of the sum of the variances along the three axes
};

/// Of the result of a run. Why not, in one sentence with the remedy: it is no result of a tool, or one on the
/// arm of another calibration than run `of_run` (empty: any); it was not accepted.
std::variant<TouchedTool, std::string> touched_tool_of(const std::string& from, std::string_view result_json,
                                                       const std::string& of_run);

/// The tool with its tip where it was touched on the calibrated arm. It points where the drawing says.
calib::CompensationTool as_touched(const calib::CompensationTool& drawn, const TouchedTool& touched);

/// What is told of it beside the corrected targets.
CompensationDocument::Touched told_of(const TouchedTool& touched);

}  // namespace cell
