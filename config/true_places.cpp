#include "config/true_places.hpp"

#include <algorithm>
#include <string>

#include "config/config_error.hpp"
#include "config/strict_json.hpp"
#include "config/touched_places.hpp"

namespace cell {
namespace {

void demand_places_of_block(const Truth& truth, const Block& block) {
  for (const TruePlace& place : truth.places) {
    if (std::ranges::find(block.places, place.name, &BlockPlace::name) != block.places.end()) continue;
    std::string known;
    for (const BlockPlace& there : block.places) known += (known.empty() ? "" : ", ") + in_quotes(there.name);
    throw ConfigError(truth.file.string(), "/places" + pointer_step(place.name),
                      "the block " + in_quotes(block.name) + " has no such place" +
                          (known.empty() ? R"(; leave "places" out, or give the block's file "places")"
                                         : "; give one of " + known));
  }
}

}  // namespace

std::vector<Eigen::Isometry3d> true_places(const Truth& truth, const Block& block) {
  demand_places_of_block(truth, block);
  std::vector<Eigen::Isometry3d> poses;
  for (const BlockPlace& place : block.places) {
    Eigen::Isometry3d pose = place.first_from_place;
    pose.translation() += true_warmth_k(truth, block) * place_growth_m_per_k(block, place);
    const auto off = std::ranges::find(truth.places, place.name, &TruePlace::name);
    if (off != truth.places.end()) {
      pose.translation() += off->shift_m;
      const double angle_rad = off->turn_rad.norm();
      if (angle_rad > 0.0)
        pose.linear() =
            Eigen::AngleAxisd(angle_rad, off->turn_rad / angle_rad).toRotationMatrix() * pose.linear();
    }
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace cell
