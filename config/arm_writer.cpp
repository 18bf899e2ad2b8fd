#include "config/arm_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/arm_file.hpp"
#include "config/arm_uncertainty.hpp"
#include "config/joint_units.hpp"

namespace cell {
namespace {

using calib::kFrameCount;
using calib::kJointCount;
using calib::kMetresPerMillimetre;
using Json = nlohmann::ordered_json;  // keys in the order a reader expects

double finite(double number) {
  if (!std::isfinite(number)) throw std::logic_error("an arm with a figure that is not finite is written");
  return number;
}

/// The shortest number of `unit`s that reads back as `si`: 149.6, not 149.60000000000002.
double in_units(double si, double unit) {
  constexpr int kDigitsMin = 12, kDigitsMax = 17;
  for (int digits = kDigitsMin; digits <= kDigitsMax; ++digits) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.*g", digits, finite(si) / unit);
    const double number = std::strtod(text.data(), nullptr);
    if (number * unit == si) return number;
  }
  return si / unit;  // not every length is a whole multiple of the last bit of its millimetres
}

double in_mm(double metres) { return in_units(metres, kMetresPerMillimetre); }

Json point_mm(const Eigen::Vector3d& point_m) {
  return {in_mm(point_m.x()), in_mm(point_m.y()), in_mm(point_m.z())};
}

Json standard_deviations(const Arm& arm, int frame) {
  static constexpr std::array<const char*, 5> kKeys{"alpha_rad", "d_mm", "theta_rad", "r_mm", "beta_rad"};
  Json json = Json::object();
  const auto& parameters = calib::error_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].frame != frame || !arm.std_errors[i]) continue;
    const double std = *arm.std_errors[i];
    json[kKeys.at(static_cast<std::size_t>(parameters[i].kind))] =
        parameters[i].is_length() ? in_mm(std) : finite(std);
  }
  return json;
}

Json frame_json(const Arm& arm, int frame) {
  const calib::LinkParameters& link = arm.model.links[static_cast<std::size_t>(frame)];
  const bool is_joint = frame >= 1 && frame <= kJointCount;
  const auto joint = static_cast<std::size_t>(frame - 1);
  Json json{{"j", frame}};
  if (is_joint) {
    const bool turns = arm.model.joint_types[joint] == calib::JointType::kRevolute;
    json["joint_type"] = turns ? "revolute" : "prismatic";
  }
  if (frame > 0) {
    json["alpha_rad"] = finite(link.alpha_rad);
    json["d_mm"] = in_mm(link.d_m);
  }
  json[is_joint ? "theta_offset_rad" : "theta_rad"] = finite(link.theta_rad);
  json["r_mm"] = in_mm(link.r_m);
  if (frame > 0) json["beta_rad"] = finite(link.beta_rad);
  if (is_joint) json["gain"] = finite(arm.model.gains[joint]);
  if (Json std = standard_deviations(arm, frame); !std.empty()) json["std"] = std::move(std);
  return json;
}

Json joint_limits_json(const Arm& arm) {
  const calib::JointVector units = joint_units(arm.model);
  Json json = Json::array();
  for (int joint = 0; joint < kJointCount; ++joint) {
    json.push_back({in_units(arm.joint_ranges.lower[joint], units[joint]),
                    in_units(arm.joint_ranges.upper[joint], units[joint])});
  }
  return json;
}

Json joint_speeds_json(const Arm& arm) {
  const calib::JointVector units = joint_units(arm.model);
  Json json = Json::array();
  for (int joint = 0; joint < kJointCount; ++joint)
    json.push_back(in_units(arm.joint_speeds_max[joint], units[joint]));
  return json;
}

std::optional<double> std_of(const Arm& arm, int nongeometric_position) {
  return arm.nongeometric_std[static_cast<std::size_t>(nongeometric_position)];
}

/// Nothing for an arm without masses: what bends them is then not known either.
Json gravity_json(const Arm& arm) {
  Json masses = Json::array();
  for (int frame = 1; frame < kFrameCount; ++frame) {
    const calib::PointMass& mass = arm.model.masses[static_cast<std::size_t>(frame)];
    if (mass.mass_kg == 0.0) continue;
    masses.push_back({{"frame", frame},
                      {"mass_kg", finite(mass.mass_kg)},
                      {"center_mm", point_mm(mass.center_in_frame_m)}});
  }
  if (masses.empty()) return nullptr;
  const Eigen::Vector3d& down = arm.model.down_in_frame_1;
  Json json{{"down_in_frame_1", {down.x(), down.y(), down.z()}}, {"masses", std::move(masses)}};
  Json compliances = Json::array(), deviations = Json::array();
  for (int joint = 0; joint < kJointCount; ++joint) {
    compliances.push_back(finite(arm.model.compliance_rad_per_nm[static_cast<std::size_t>(joint)]));
    deviations.push_back(finite(std_of(arm, calib::compliance_position(joint)).value_or(0.0)));
  }
  json["compliance_rad_per_nm"] = std::move(compliances);
  json["std_compliance_rad_per_nm"] = std::move(deviations);
  for (int frame = 1; frame < kFrameCount; ++frame) {
    if (const auto std = std_of(arm, calib::mass_position(frame))) json["std_mass_share"] = finite(*std);
  }
  return json;
}

Json pairs_json(const std::array<calib::CosSin, kJointCount>& pairs) {
  Json json = Json::array();
  for (const calib::CosSin& pair : pairs) json.push_back({finite(pair.cos), finite(pair.sin)});
  return json;
}

/// The known ripple, where a period is known.
void add_ripple(const calib::KinematicModel& model, Json& gears) {
  const auto& periods = model.ripple_periods_per_turn;
  if (std::ranges::all_of(periods, [](double p) { return p == 0.0; })) return;
  Json json = Json::array();
  for (const double p : periods) json.push_back(p == 0.0 ? Json(nullptr) : Json(finite(p)));
  gears["ripple_periods_per_turn"] = std::move(json);
  gears["ripples_rad"] = pairs_json(model.ripples_rad);
}

Json gears_json(const Arm& arm) {
  const auto six = [](const calib::JointVector& values) {
    Json json = Json::array();
    for (const double value : values) json.push_back(finite(value));
    return json;
  };
  Json json{{"harmonics_rad", pairs_json(arm.model.harmonics_rad)},
            {"ripple_rad", six(arm.gears.ripple_rad)},
            {"backlash_rad", six(arm.gears.backlash_rad)},
            {"repeatability_rad", six(arm.gears.repeatability_rad)}};
  add_ripple(arm.model, json);
  for (int joint = 0; joint < kJointCount; ++joint) {
    if (const auto std = std_of(arm, calib::harmonic_position(joint)))
      json["std_harmonic_rad"] = finite(*std);
  }
  return json;
}

Json body_json(const calib::Capsule& body) {
  return {{"name", body.name},
          {"frame", body.frame},
          {"from_mm", point_mm(body.from_m)},
          {"to_mm", point_mm(body.to_m)},
          {"radius_mm", in_mm(body.radius_m)}};
}

/// An array with each entry on a line of its own.
std::string lines(const Json& array) {
  std::string text = "[";
  for (const Json& entry : array) text += (text.size() > 1 ? ",\n    " : "\n    ") + entry.dump();
  return text + (array.empty() ? "]" : "\n  ]");
}

}  // namespace

std::string arm_document(const Arm& arm) {
  Json frames = Json::array();
  for (int frame = 0; frame < kFrameCount; ++frame) frames.push_back(frame_json(arm, frame));
  Json bodies = Json::array();
  for (const calib::Capsule& body : arm.bodies) bodies.push_back(body_json(body));
  const Json gravity = gravity_json(arm);

  std::string text = "{\n  \"schema\": " + Json(arm.serial ? kArmSchema : kFourthArmSchema).dump() +
                     ",\n  \"name\": " + Json(arm.name).dump();
  if (arm.serial) text += ",\n  \"serial\": " + Json(*arm.serial).dump();
  text += ",\n  \"frames\": " + lines(frames);
  text += ",\n  \"joint_limits_deg\": " + joint_limits_json(arm).dump();
  text += ",\n  \"joint_max_speeds_deg_s\": " + joint_speeds_json(arm).dump();
  if (!gravity.is_null()) text += ",\n  \"gravity\": " + gravity.dump();
  text += ",\n  \"gears\": " + gears_json(arm).dump();
  if (arm.growth) {
    const Json warming{{"expansion_per_k", finite(arm.growth->expansion_per_k)},
                       {"rise_k", finite(arm.growth->rise_k)}};
    text += ",\n  \"warming\": " + warming.dump();
  }
  if (arm.covariance) text += ",\n  \"uncertainty\": " + arm_covariance_text(*arm.covariance);
  text += ",\n  \"bodies\": " + lines(bodies) + "\n}\n";
  return text;
}

}  // namespace cell
