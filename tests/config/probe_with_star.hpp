#pragma once

#include <array>
#include <cmath>
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

/// From the axis of the probe up to the ball.
inline nlohmann::json stem_of_tip(const nlohmann::json& tip) {
  const auto ball = tip.at("center_mm").get<std::array<double, 3>>();
  const double radius = tip.at("radius_mm").is_number() ? tip.at("radius_mm").get<double>() : 0.0;
  const double out = std::hypot(ball[0], ball[1]), share = out > 0.0 ? 1.0 - (radius + 1.0) / out : 0.0;
  return {{"name", tip.at("name").get<std::string>() + " stem"},
          {"from_mm", {0, 0, ball[2]}},
          {"to_mm", {share * ball[0], share * ball[1], ball[2]}},
          {"radius_mm", 1}};
}

/// Gives a probe's document these tips, and their balls and stems as bodies.
inline void add_tips(nlohmann::json& probe, const nlohmann::json& tips) {
  probe["schema"] = "touchcal/probe/4";
  probe["tips"] = tips;
  for (const nlohmann::json& tip : tips) {
    probe["bodies"].push_back(ball_of_tip(tip));
    probe["bodies"].push_back(stem_of_tip(tip));
  }
}

}  // namespace cell
