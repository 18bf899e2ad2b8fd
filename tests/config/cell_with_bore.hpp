#pragma once

#include "tests/config/cell_with_ball.hpp"

namespace cell {

/// A ring with a bore of 84 mm beside the block, as the sixth face of the cell `demo`; where it lies is to be
/// found.
inline nlohmann::json bore_of_ring() {
  return {{"plane", 6},
          {"shape", "bore"},
          {"solid", "ring"},
          {"mouth_mm", {140, -60, 110}},
          {"axis", {0, -1, 0}},
          {"std_tilt_rad", 0.005},
          {"radius_mm", 42},
          {"std_radius_mm", 0.001},
          {"depth_mm", {2, 42}},
          {"wall_middle", {1, 0, 0}},
          {"wall_half_angle_deg", 180},
          {"place", "estimated"}};
}

/// The block of the cell `demo` with `bore` and its ring; the plate's face may be touched in front of it.
inline nlohmann::json block_with_ring(const nlohmann::json& bore) {
  nlohmann::json block = json_of(kSourceDir / "config/cells/demo/block.json");
  block["schema"] = "touchcal/block/2";
  block.erase("places");
  block.erase("serial");  // came with the third
  block["faces"][4]["center_mm"] = {140, 0, -70};
  block["faces"][4]["half_extent_mm"] = {50, 100};
  block["faces"].push_back(bore);
  block["solids"].push_back({{"name", "ring"}, {"min_mm", {90, -60, 60}}, {"max_mm", {190, 0, 160}}});
  return block;
}

}  // namespace cell
