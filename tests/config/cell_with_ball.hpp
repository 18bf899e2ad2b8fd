#pragma once

#include <nlohmann/json.hpp>

#include "config/read_config.hpp"
#include "folder.hpp"

namespace cell {

/// A ball of 50 mm on a post beside the block, as the sixth face of the cell `demo`; where it stands is to be
/// found.
inline nlohmann::json ball_face() {
  return {{"plane", 6},
          {"shape", "sphere"},
          {"center_mm", {140, -180, 110}},
          {"radius_mm", 25},
          {"std_radius_mm", 0.001},
          {"cap_axis", {0, -1, 0}},
          {"cap_half_angle_deg", 100},
          {"place", "estimated"}};
}

/// The block of the cell `demo` with `ball` and its post.
inline nlohmann::json block_with(const nlohmann::json& ball) {
  nlohmann::json block = json_of(kSourceDir / "config/cells/demo/block.json");
  block["schema"] = "touchcal/block/2";
  block.erase("places");
  block.erase("serial");  // came with the third
  block["faces"].push_back(ball);
  block["solids"].push_back({{"name", "post"}, {"min_mm", {135, -160, 105}}, {"max_mm", {145, 0, 115}}});
  return block;
}

/// A cell file in `folder`: the cell `demo` with this block.
inline std::filesystem::path write_demo_with(const nlohmann::json& block, const Folder& folder) {
  const std::filesystem::path demo = kSourceDir / "config/cells/demo";
  nlohmann::json cell = json_of(demo / "cell.json");
  for (const char* key : {"arm", "probe"}) cell[key] = (demo / cell[key].get<std::string>()).string();
  for (auto& recipe : cell["recipes"]) recipe = (demo / recipe.get<std::string>()).string();
  cell["block"] = folder.write("block.json", block.dump()).string();
  return folder.write("cell.json", cell.dump());
}

}  // namespace cell
