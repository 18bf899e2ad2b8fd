#include "config/probe_file.hpp"

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/shapes.hpp"

namespace cell {
namespace {

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
}

void refuse_stylus(const JsonObject& object) {
  for (const char* key : {"stylus_radius_mm", "std_stylus_radius_mm", "pretravel_mm", "std_pretravel_mm"}) {
    if (const auto value = object.find(key)) {
      value->fail(
          "a tip that is the contact point has no ball and no pre-travel; remove this or "
          "tip_is_contact_point");
    }
  }
}

}  // namespace

Probe read_probe(const std::filesystem::path& file) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const JsonObject object =
      JsonValue(source, document)
          .document(kProbeSchema, {"schema", "name", "tip_is_contact_point", "stylus_radius_mm",
                                   "std_stylus_radius_mm", "pretravel_mm", "std_pretravel_mm",
                                   "overtravel_mm", "calibration_speed_mm_s", "bodies", "certificate"});
  Probe probe;
  probe.name = object.at("name").text();
  if (const auto certificate = object.find("certificate")) {
    for (const auto& [key, value] : certificate->members()) probe.certificate.emplace(key, value.text());
  }
  if (const auto declared = object.find("tip_is_contact_point"))
    probe.tip_is_contact_point = declared->boolean();
  if (probe.tip_is_contact_point) {
    refuse_stylus(object);
  } else {
    read_stylus(object, probe);
  }
  probe.overtravel_m = object.metres("overtravel", kPositive);
  probe.calibration_speed_m_s = calib::metres_from_mm(object.at("calibration_speed_mm_s").number(kPositive));
  probe.bodies = capsules_from_json(object.at("bodies"), calib::kFrameCount - 1);
  return probe;
}

}  // namespace cell
