#include "config/probe_file.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/probe_tips_file.hpp"
#include "config/schema_version.hpp"
#include "config/serial_number.hpp"
#include "config/shapes.hpp"

namespace cell {
namespace {

/// No probe's pre-travel depends more on the direction of the push (mm); more is a typo.
constexpr NumberRange kSidewaysMm{-1.0, 1.0};
constexpr NumberRange kSidewaysStdMm{0.0, 1.0};
constexpr std::array kSidewaysKeys{"pretravel_tilt_mm", "std_pretravel_tilt_mm", "lobes_mm",
                                   "std_lobes_mm",      "lobe_direction_deg",    "lobe_direction_rad"};

void read_sideways(const JsonObject& object, Probe& probe) {
  calib::SidewaysPretravel& sideways = probe.stylus.sideways;
  sideways.tilt_m = object.find_metres("pretravel_tilt", kSidewaysMm).value_or(0.0);
  probe.std_pretravel_tilt_m = object.find_metres("std_pretravel_tilt", kSidewaysStdMm).value_or(0.0);
  sideways.lobes_m = object.find_metres("lobes", kSidewaysMm).value_or(0.0);
  probe.std_lobes_m = object.find_metres("std_lobes", kSidewaysStdMm).value_or(0.0);
  const auto direction_rad = object.find_radians("lobe_direction");
  sideways.lobe_direction_rad = direction_rad.value_or(0.0);
  if (sideways.lobes_m != 0.0 && !direction_rad) {
    object.at("lobes_mm")
        .fail(
            R"(lobes have a direction; add "lobe_direction_deg", or give only "std_lobes_mm" where it is not known)");
  }
  if (direction_rad && sideways.lobes_m == 0.0) {
    object.at(object.has("lobe_direction_deg") ? "lobe_direction_deg" : "lobe_direction_rad")
        .fail(
            R"(there are no lobes that this could be the direction of; add "lobes_mm" over 0 or remove it)");
  }
  const double least_m = probe.stylus.pretravel_m + sideways.tilt_m - std::abs(sideways.lobes_m);
  const double most_m = probe.stylus.pretravel_m + sideways.tilt_m + std::abs(sideways.lobes_m);
  if (least_m < 0.0 || most_m > probe.overtravel_m) {
    object.fail(
        "\"pretravel_mm\", \"pretravel_tilt_mm\" and \"lobes_mm\" together let a push from the side trip the "
        "probe " +
        std::string(least_m < 0.0 ? "before it touches" : "beyond \"overtravel_mm\"") +
        "; check these figures, lengths are in mm");
  }
}

constexpr std::array kProbeSchemas{kFirstProbeSchema, kSecondProbeSchema, kThirdProbeSchema, kProbeSchema};

void read_stylus(const JsonObject& object, Probe& probe) {
  for (const char* key : {"stylus_radius_mm", "pretravel_mm"}) {
    if (!object.has(key)) {
      object.fail('"' + std::string(key) +
                  "\" is missing and unknown is not zero; add it, or \"tip_is_contact_point\":true if there "
                  "is no ball");
    }
  }
  probe.stylus.radius_m = object.metres("stylus_radius", kPositive);
  probe.stylus.pretravel_m = object.metres("pretravel", kNotNegative);
  probe.std_stylus_radius_m = object.find_metres("std_stylus_radius", kNotNegative).value_or(0.0);
  probe.std_pretravel_m = object.find_metres("std_pretravel", kNotNegative).value_or(0.0);
  read_sideways(object, probe);
}

void refuse_stylus(const JsonObject& object) {
  const auto refuse = [&object](const char* key) {
    if (const auto value = object.find(key)) {
      value->fail(
          "a tip that is the contact point has no ball and no pre-travel; remove this or "
          "tip_is_contact_point");
    }
  };
  for (const char* key : {"stylus_radius_mm", "std_stylus_radius_mm", "pretravel_mm", "std_pretravel_mm"})
    refuse(key);
  for (const char* key : kSidewaysKeys) refuse(key);
  if (const auto tips = object.find("tips"))
    tips->fail("stand beside a first tip that has no ball; remove this or tip_is_contact_point");
}

}  // namespace

Probe read_probe(const std::filesystem::path& file) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const SchemaVersion version = schema_version(document, "probe", kProbeSchemas);
  const JsonObject object =
      JsonValue(source, document)
          .document(
              kProbeSchemas[static_cast<std::size_t>(version.number) - 1],
              {"schema", "name", "serial", "tip_is_contact_point", "stylus_radius_mm", "std_stylus_radius_mm",
               "pretravel_mm", "std_pretravel_mm", "pretravel_tilt_mm", "std_pretravel_tilt_mm", "lobes_mm",
               "std_lobes_mm", "lobe_direction_deg", "lobe_direction_rad", "overtravel_mm",
               "calibration_speed_mm_s", "bodies", "certificate", "tips"});
  for (const char* key : kSidewaysKeys) static_cast<void>(find_since(2, object, key, version));
  const auto tips = find_since(4, object, "tips", version);
  Probe probe;
  probe.name = object.at("name").text();
  probe.serial = serial_number(find_since(3, object, "serial", version));
  if (const auto certificate = object.find("certificate")) {
    for (const auto& [key, value] : certificate->members()) probe.certificate.emplace(key, value.text());
  }
  if (const auto declared = object.find("tip_is_contact_point"))
    probe.tip_is_contact_point = declared->boolean();
  probe.overtravel_m = object.metres("overtravel", kPositive);
  if (probe.tip_is_contact_point) {
    refuse_stylus(object);
  } else {
    read_stylus(object, probe);
  }
  probe.calibration_speed_m_s = calib::metres_from_mm(object.at("calibration_speed_mm_s").number(kPositive));
  probe.bodies = capsules_from_json(object.at("bodies"), calib::kFrameCount - 1);
  if (tips) probe.tips = probe_tips_from_json(*tips, probe);
  loosen_bodies(probe);
  return probe;
}

}  // namespace cell
