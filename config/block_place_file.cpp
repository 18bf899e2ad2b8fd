#include "config/block_place_file.hpp"

#include <string>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/shapes.hpp"
#include "config/short_name.hpp"

namespace cell {
namespace {

std::string place_name_from_json(const JsonValue& value) {
  std::string name = short_name(value);
  if (name == kFirstPlace)
    value.fail(R"("first" is the place where the block is located; give this one another name)");
  return name;
}

/// An exact place would be no statement that anybody can make, and one known to a centimetre is not known.
constexpr NumberRange kPositionStdMm{.min = 1e-5, .max = 1.0};
constexpr NumberRange kTurnStdRad{.min = 1e-8, .max = 0.01};
constexpr NumberRange kWithinMm{.min = 0.0, .max = 50.0};
constexpr NumberRange kStandExpansions{.min = 0.0, .max = 1e-3};

}  // namespace

bool is_estimated_place(const JsonObject& object) {
  const JsonValue place = object.at("place");
  const std::string text = place.text();
  if (text != "known" && text != "estimated")
    place.fail("is " + in_quotes(text) + R"(; give "known" or "estimated")");
  return text == "estimated";
}

BlockPlace block_place_from_json(const JsonValue& value) {
  const JsonObject object = value.object({"name", "position_mm", "rotation_deg", "place", "std_position_mm",
                                          "std_rotation_rad", "within_mm", "thermal_expansion_per_k"});
  BlockPlace place{.name = place_name_from_json(object.at("name")),
                   .first_from_place = pose_from_json(object)};
  const bool estimated = is_estimated_place(object);
  for (const char* key : {"std_position_mm", "std_rotation_rad"}) {
    if (const auto std = object.find(key); std && estimated)
      std->fail(R"(stands at a place that is found by the touches; leave it out, or give "place": "known")");
  }
  if (const auto within = object.find("within_mm"); within && !estimated)
    within->fail(R"(stands at a place that is known; leave it out, or give "place": "estimated")");
  if (estimated) {
    place.within_m = calib::metres_from_mm(object.at("within_mm").number(kWithinMm));
  } else {
    place.std = calib::PlaceDeviation{
        .std_position_m = calib::metres_from_mm(object.at("std_position_mm").number(kPositionStdMm)),
        .std_turn_rad = object.at("std_rotation_rad").number(kTurnStdRad)};
  }
  if (const auto expansion = object.find("thermal_expansion_per_k"))
    place.thermal_expansion_per_k = expansion->number(kStandExpansions);
  return place;
}

}  // namespace cell
