#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "service/setup/made_arm.hpp"

namespace cell {

/// The arm of a table of Denavit-Hartenberg parameters, in one of two forms of CSV:
///
/// - what `touchcal export --dh` writes (service/exports/dh_tables.hpp): its rows "modified", else
/// "standard";
/// - six rows, or seven with a fixed tool, with the columns theta, d, a, alpha in any order, each with its
///   unit behind its name (theta_deg or theta_rad, d_mm or d_m, ...). `convention` says which one it is:
///   "standard"  row j is Rot(z,theta + joint j) Trans(z,d) Trans(x,a) Rot(x,alpha)
///   "modified"  row j is Rot(x,alpha) Trans(x,a) Rot(z,theta + joint j) Trans(z,d)
///
/// R_-1 is the frame before the first row, R_7 that behind the last one. Blank lines and lines of # are
/// comments. A table has no ranges, speeds and masses: the remarks say what was assumed. ConfigError with the
/// line and the remedy.
MadeArm arm_of_dh(const std::string& source, std::string_view text, const std::string& convention = "");
MadeArm arm_of_dh_file(const std::filesystem::path& file, const std::string& convention = "");

}  // namespace cell
