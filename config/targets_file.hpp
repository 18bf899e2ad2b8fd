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
#include "config/target_frames.hpp"

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
/// As RoboDK writes a list of targets (its macro ExportTargets; a pose as of a Staubli arm), and behind it
/// the joints, without which a pose does not say its configuration. Lines of '#' may stand before it.
/// Begins the first remark of a list that touchcal wrote: its poses hold the correction.
inline constexpr std::string_view kCorrectedRemark = "touchcal: corrected";
inline constexpr std::string_view kRobodkHeader = "Name, X, Y, Z, Rx, Ry, Rz, J1, J2, J3, J4, J5, J6";
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
  /// Poses of a list that does not say in which frame they are: as if that were the controller's world.
  bool leaves_frame_open = false;
  std::vector<Target> targets;
  std::optional<double> line_max_m;  // how far the tool may be off a straight line, where the file says

  [[nodiscard]] bool may_have_lines() const { return version >= kTargetLinesVersion; }
};

/// JSON; a list of poses when it has kRobodkHeader; CSV when the file's name ends in .csv or its first line
/// is kTargetsCsvHeader. A CSV and a list name no tool: their targets are of the stylus. `frames`: of the
/// cell, which JSON may name. ConfigError: what is not as config/FILES.md says, a frame that the cell does
/// not have or that was touched with the nominal arm; of CSV and list it names the line.
TargetsFile read_targets(const std::filesystem::path& file, const TargetFrames& frames = {});

/// The same from memory. `source` is how messages call the bytes.
TargetsFile targets_from_json(const std::string& source, std::string_view bytes, std::size_t size_max_bytes,
                              const TargetFrames& frames = {});
TargetsFile targets_from_csv(const std::string& source, std::string_view bytes);
TargetsFile targets_from_robodk(const std::string& source, std::string_view bytes);

}  // namespace cell
