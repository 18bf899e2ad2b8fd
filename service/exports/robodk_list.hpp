#pragma once

#include <array>
#include <string>
#include <vector>

namespace cell {

/// A target as it is to be commanded.
struct ListedPose {
  std::string name;
  /// Of the tool in the controller's world, by the controller's own model at `joints_deg`: x, y, z in mm, rx,
  /// ry, rz in degrees, turned by Rot(x) Rot(y) Rot(z).
  std::array<double, 6> world_from_tool{};
  std::array<double, 6> joints_deg{};
};

/// A list of targets as RoboDK's macro ExportTargets writes it, with the joints behind each pose. Lines of
/// '#' first: `remarks`, a line each, then signs, units and frame of each figure; then kRobodkHeader and a
/// line a target, 6 decimals. read_targets() reads it.
std::string robodk_list(const std::vector<ListedPose>& poses, const std::vector<std::string>& remarks);

}  // namespace cell
