#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "config/read_config.hpp"
#include "tests/config/folder.hpp"

namespace cell {

/// The cell `demo` with another shipped arm in it, read from a file in `folder`.
inline Cell demo_with(const std::string& arm, const Folder& folder) {
  const std::filesystem::path demo = kSourceDir / "config/cells/demo";
  nlohmann::json cell = json_of(demo / "cell.json");
  for (const char* key : {"block", "probe"}) cell[key] = (demo / cell[key].get<std::string>()).string();
  for (auto& recipe : cell["recipes"]) recipe = (demo / recipe.get<std::string>()).string();
  cell["arm"] = (kSourceDir / "config/arms" / (arm + ".json")).string();
  if (arm == "tx60") {
    // It stands 205 mm nearer to the block, where the table would go through its foot, and its short forearm
    // leaves a tool holder of 80 mm no room.
    cell["keep_out_boxes"][0]["min_mm"][0] = -280;
    cell["park_joints_deg"] = {0, 0, 60, 0, 45, 0};
    nlohmann::json probe = json_of(demo / "probe.json");
    probe["bodies"][0]["radius_mm"] = 25;
    cell["probe"] = folder.write("probe.json", probe.dump()).string();
  }
  return read_cell(folder.write("cell.json", cell.dump()));
}

}  // namespace cell
