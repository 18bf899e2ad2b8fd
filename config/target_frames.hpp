#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace cell {

class JsonValue;

/// The one frame that every controller has.
inline constexpr std::string_view kWorldFrame = "world";
inline constexpr std::size_t kTargetFrameCountMax = 1000;
inline constexpr std::size_t kTargetFrameNameSizeMax = 64;  // bytes

/// A frame of the cell that targets may be given in: a pallet, a fixture.
struct TargetFrame {
  Eigen::Isometry3d world_from_frame = Eigen::Isometry3d::Identity();  // the controller's world
  /// Its pose was read from the arm by the nominal model: it holds the arm's errors there, and a compensated
  /// target in it would be off by them.
  bool is_touched_nominally = false;
};
using TargetFrames = std::map<std::string, TargetFrame>;  // by name

/// {"NAME":{"position_mm":[3],"rotation_deg":[3],"touched":"no"|"calibrated"|"nominal"}}. ConfigError for
/// another name than 1 to kTargetFrameNameSizeMax bytes, for kWorldFrame, for more than kTargetFrameCountMax.
TargetFrames target_frames_from_json(const JsonValue& value);

/// Why a target may not be given in the frame of this name, with those that there are; empty where it may.
std::string why_no_target_frame(const TargetFrames& frames, const std::string& name);

/// Of a frame for which why_no_target_frame() is empty.
Eigen::Isometry3d world_from_target_frame(const TargetFrames& frames, const std::string& name);

}  // namespace cell
