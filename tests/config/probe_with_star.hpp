#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace cell {

/// A further tip of the shipped demo probe, whose own ball has a radius of 3 mm.
inline nlohmann::json star_tip(const std::string& name, const nlohmann::json& center_mm,
                               const nlohmann::json& direction) {
  return {{"name", name},   {"center_mm", center_mm}, {"direction", direction},
          {"within_mm", 1}, {"radius_mm", 2},         {"std_radius_mm", 0.005}};
}

inline nlohmann::json ball_of_tip(const nlohmann::json& tip) {
  return {{"name", tip.at("name").get<std::string>() + " ball"},
          {"from_mm", tip.at("center_mm")},
          {"to_mm", tip.at("center_mm")},
          {"radius_mm", tip.at("radius_mm")}};
}

/// Gives a probe's document these tips, and their balls as bodies.
inline void add_tips(nlohmann::json& probe, const nlohmann::json& tips) {
  probe["schema"] = "touchcal/probe/4";
  probe["tips"] = tips;
  for (const nlohmann::json& tip : tips) probe["bodies"].push_back(ball_of_tip(tip));
}

}  // namespace cell
