#pragma once

#include <nlohmann/json.hpp>

#include "cell_with_ball.hpp"

namespace cell {

inline constexpr const char* kTwoPlaces = "two places";
/// Of `kTwoPlaces`, on each plane of each place.
inline constexpr int kFitAtEach = 7;
inline constexpr int kHeldOutAtEach = 2;

/// A stand under the cube that lifts it by 300 mm, into dowels; y of R_-1 points down.
inline nlohmann::json known_stand() {
  return {{"name", "stand"},  {"position_mm", {0, -300, 0}}, {"rotation_deg", {0, 0, 0}},
          {"place", "known"}, {"std_position_mm", 0.01},     {"std_rotation_rad", 3e-5}};
}

/// The same where nobody has measured it.
inline nlohmann::json estimated_stand(double within_mm) {
  nlohmann::json stand = known_stand();
  for (const char* key : {"std_position_mm", "std_rotation_rad"}) stand.erase(key);
  stand["place"] = "estimated";
  stand["within_mm"] = within_mm;
  return stand;
}

/// A cell file in `folder`: the cell `demo` whose block has this further place, and a recipe there.
inline std::filesystem::path write_demo_at_two_places(const nlohmann::json& place, const Folder& folder) {
  nlohmann::json block = json_of(kSourceDir / "config/cells/demo/block.json");
  block["schema"] = "touchcal/block/4";
  block["places"] = {place};
  nlohmann::json recipe = json_of(kSourceDir / "config/recipes/quick.json");
  recipe["schema"] = "touchcal/recipe/4";
  recipe["name"] = kTwoPlaces;
  recipe["places"] = {place.at("name")};
  recipe["touches"] = {{"planes", "all"},
                       {"fit_per_plane", kFitAtEach},
                       {"held_out_per_plane", kHeldOutAtEach},
                       {"criterion", "tip_box"}};
  const std::filesystem::path file = write_demo_with(block, folder);
  nlohmann::json cell = json_of(file);
  cell["recipes"].push_back(folder.write("two-places.json", recipe.dump()).string());
  return folder.write("cell.json", cell.dump());
}

}  // namespace cell
