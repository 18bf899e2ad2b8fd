#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "calib_core/compensation/compensation.hpp"
#include "service/offline_programs/filter_list.hpp"
#include "service/offline_programs/offline_target.hpp"

namespace cell {

/// The arm that a corrector is made for.
struct CalibratedArm {
  calib::CompensationProblem problem;
  std::map<std::string, calib::CompensationTool, std::less<>> tools;  // by the names that a list uses
  /// In place of the calibrated arm of the problem: of tools that were touched.
  std::map<std::string, calib::KinematicModel, std::less<>> arms_by_tool = {};
  /// Where a point leaves its configuration open, that of these joints is taken.
  calib::JointVector reference_joints = calib::JointVector::Zero();
  /// What is said of a target that is warned of or refused.
  std::function<std::string(const calib::CompensatedTarget&)> reason_of;
};

/// A point whose configuration is open ("same", "free") is warned of when the corrections of the
/// configurations that it allows are further apart than this.
inline constexpr double kOpenConfigurationMm = 0.02;

/// Corrects what filter_data() asks by calib::Compensation. A pose is taken in the configuration that its
/// words ask for (manual 6, pages 135 and 136: `lefty` is an arm whose wrist lies ahead of joint 1); an open
/// word means that of `reference_joints`.
/// A target of a tool that is not there is a std::logic_error: demand_tools() comes first. Throws what
/// calib::Compensation throws.
Corrector calibrated_corrector(CalibratedArm arm);

/// Throws ConfigError with the line of the list where an offline variable names no tool, or one that is not
/// among these. A tool is needed for joints too: their correction is that of the tool's tip.
void demand_tools(const FilterList& list, const std::vector<std::string>& tools);

}  // namespace cell
