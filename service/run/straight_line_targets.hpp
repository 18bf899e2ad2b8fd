#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/compensation/straight_line.hpp"
#include "config/cell.hpp"
#include "config/targets_file.hpp"

namespace cell {

/// A target of the file, or a point that a straight line needs.
struct PathTarget {
  std::string name;
  calib::CompensatedTarget result;
  bool is_inserted = false;
  std::string line_from;  // of the end of a line: the name of its start; else empty
  /// What was found of that line, its points moved out of it; nothing where it was not judged, because one of
  /// its ends is refused for itself.
  std::optional<calib::LineCorrection> line = {};
};

/// How far the tool may be off the lines of a file, metres: what is `given`, else what the file says, else
/// kLineDeviationMaxMetres.
double line_max_m(const TargetsFile& file, const std::optional<double>& given);

/// The targets of the file as compensated() has them, in their order, and before the end of each straight
/// line the points that it needs, named NAME.1, NAME.2, ... after that end. The end of a line that cannot be
/// held is refused; the end of one whose start is refused is warned of. `source` is how messages call the
/// file. ConfigError with the target: the name of a point is that of a target or too long; more than
/// kTargetCountMax targets and points.
std::vector<PathTarget> compensated_path(const Cell& cell, const Arm& arm,
                                         const calib::CompensationTool& tool, const TargetsFile& file,
                                         double deviation_max_m, const std::string& source);

}  // namespace cell
