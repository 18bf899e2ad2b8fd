#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "service/setup/made_arm.hpp"

namespace cell {

/// Larger descriptions are refused; those of arms have some ten kilobytes.
inline constexpr std::size_t kUrdfSizeMax = 4U << 20U;

/// The arm between two links of a URDF robot (wiki.ros.org/urdf/XML): six joints that turn, of any axes, and
/// fixed ones between. R_-1 is the base link, R_7 the tip link: forward_kinematics() of the arm is the pose
/// of the tip in the base within kPositionErrorMaxMetres. Limits, speeds and masses are those of the file.
/// ConfigError that names the link or joint and the remedy: no chain from base to tip, not six joints that
/// turn, one that slides, floats or mimics another, what is no finite number, xacro that was not expanded.
MadeArm arm_of_urdf(const std::string& source, std::string_view text, const std::string& base_link,
                    const std::string& tip_link);
MadeArm arm_of_urdf_file(const std::filesystem::path& file, const std::string& base_link,
                         const std::string& tip_link);

}  // namespace cell
