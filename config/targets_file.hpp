#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"

namespace cell {

/// Of the newest version; the first one, which has no straight lines, is read too.
inline constexpr std::string_view kTargetsSchema = "touchcal/targets/2";
inline constexpr std::string_view kFirstTargetsSchema = "touchcal/targets/1";
/// The version with `move` and `line_max_mm`.
inline constexpr int kTargetLinesVersion = 2;
inline constexpr std::string_view kTargetsCsvHeader = "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg";
inline constexpr std::size_t kTargetCountMax = 100'000;
/// Room for kTargetCountMax targets with every number on a line of its own.
inline constexpr std::size_t kTargetsSizeMax = 64U << 20U;
inline constexpr std::size_t kTargetNameSizeMax = 64;  // bytes
/// The one tool that every cell has: the centre of the probe's stylus ball.
inline constexpr std::string_view kStylusTool = "stylus";
/// The one frame that every controller has.
inline constexpr std::string_view kWorldFrame = "world";
/// How far the tool may be off a straight line, at least and at most, millimetres.
inline constexpr double kLineMaxSmallestMm = 0.001;
inline constexpr double kLineMaxLargestMm = 10.0;

/// A pose of the tool in the controller's world, and the joints whose configuration and turns it is meant in.
struct PoseTarget {
  Eigen::Isometry3d world_from_tool;
  calib::JointVector near_joints;
};

/// How the arm comes to a target from the one before it.
enum class TargetMove {
  kJoint,  // joint by joint; the way does not count
  kLine,   // the tool's centre on a straight line
};

struct Target {
  std::string name;
  /// Joints mean the pose that the nominal arm has there.
  std::variant<calib::JointVector, PoseTarget> wanted;
  TargetMove move = TargetMove::kJoint;
};

/// Targets of one tool, in the order of the file; each name is there once, and the first is at the end of no
/// line.
struct TargetsFile {
  int version = 1;  // of its schema; a CSV is as the first
  std::string tool{kStylusTool};
  bool names_tool = false;  // the file does; a CSV cannot
  std::vector<Target> targets;
  std::optional<double> line_max_m;  // how far the tool may be off a straight line, where the file says

  [[nodiscard]] bool may_have_lines() const { return version >= kTargetLinesVersion; }
};

/// JSON, or CSV when the file's name ends in .csv or its first line is kTargetsCsvHeader. A CSV names no
/// tool: its targets are of the stylus. ConfigError: what is not as config/FILES.md says, a frame that is not
/// the controller's world, as no cell has others; a CSV error names its line.
TargetsFile read_targets(const std::filesystem::path& file);

/// The same from memory. `source` is how messages call the bytes.
TargetsFile targets_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes);
TargetsFile targets_from_csv(const std::string& source, std::string_view bytes);

}  // namespace cell
