#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"

namespace cell {

inline constexpr std::string_view kTargetsSchema = "touchcal/targets/1";
inline constexpr std::string_view kTargetsCsvHeader = "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg";
inline constexpr std::size_t kTargetCountMax = 100'000;
/// Room for kTargetCountMax targets with every number on a line of its own.
inline constexpr std::size_t kTargetsSizeMax = 64U << 20U;
inline constexpr std::size_t kTargetNameSizeMax = 64;  // bytes
/// The one tool that every cell has: the centre of the probe's stylus ball.
inline constexpr std::string_view kStylusTool = "stylus";
/// The one frame that every controller has.
inline constexpr std::string_view kWorldFrame = "world";

/// A pose of the tool in the controller's world, and the joints whose configuration and turns it is meant in.
struct PoseTarget {
  Eigen::Isometry3d world_from_tool;
  calib::JointVector near_joints;
};

struct Target {
  std::string name;
  /// Joints mean the pose that the nominal arm has there.
  std::variant<calib::JointVector, PoseTarget> wanted;
};

/// Targets of one tool, in the order of the file; each name is there once.
struct TargetsFile {
  std::string tool{kStylusTool};
  bool names_tool = false;  // the file does; a CSV cannot
  std::vector<Target> targets;
};

/// JSON, or CSV when the file's name ends in .csv or its first line is kTargetsCsvHeader. A CSV names no
/// tool: its targets are of the stylus. ConfigError: what is not as config/FILES.md says, a frame that is not
/// the controller's world, as no cell has others; a CSV error names its line.
TargetsFile read_targets(const std::filesystem::path& file);

/// The same from memory. `source` is how messages call the bytes.
TargetsFile targets_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes);
TargetsFile targets_from_csv(const std::string& source, std::string_view bytes);

}  // namespace cell
