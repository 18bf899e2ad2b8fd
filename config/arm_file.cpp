#include "config/arm_file.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/joint_units.hpp"
#include "config/shapes.hpp"

namespace cell {
namespace {

using calib::kFrameCount;
using calib::kJointCount;

constexpr NumberRange kGains{.min = -1000.0, .max = 1000.0};
constexpr double kGainSizeMin = 1e-3;
/// rad/Nm; at the bounds 100 Nm turn a joint by 0.6 degrees. An identified one may be a little under 0.
constexpr NumberRange kCompliances{.min = -1e-4, .max = 1e-4};

bool is_joint(int frame) { return frame >= 1 && frame <= kJointCount; }

/// The keys that a frame may have. Frame 0 has only theta and r: what comes before them is the choice of
/// R_-1.
JsonObject frame_object(const JsonValue& value, int frame) {
  if (frame == 0) return value.object({"j", "theta_deg", "theta_rad", "r_mm", "std"});
  if (is_joint(frame)) {
    return value.object({"j", "joint_type", "alpha_deg", "alpha_rad", "d_mm", "theta_offset_deg",
                         "theta_offset_rad", "r_mm", "beta_deg", "beta_rad", "gain", "std"});
  }
  return value.object({"j", "alpha_deg", "alpha_rad", "d_mm", "theta_deg", "theta_rad", "r_mm", "beta_deg",
                       "beta_rad", "std"});
}

void read_joint(const JsonObject& object, int frame, calib::KinematicModel& model) {
  const auto joint = static_cast<std::size_t>(frame - 1);
  const JsonValue type = object.at("joint_type");
  const std::string name = type.text();
  if (name != "revolute" && name != "prismatic") {
    type.fail("is " + in_quotes(name) + R"(; give "revolute" or "prismatic")");
  }
  model.joint_types[joint] = name == "revolute" ? calib::JointType::kRevolute : calib::JointType::kPrismatic;
  const JsonValue gain = object.at("gain");
  model.gains[joint] = gain.number(kGains);
  if (std::abs(model.gains[joint]) < kGainSizeMin)
    gain.fail("is " + plain_number(model.gains[joint]) + "; a joint that moves has a gain, 1 as a rule");
}

std::optional<double> std_of(const JsonObject& object, calib::ParameterKind kind) {
  switch (kind) {
    case calib::ParameterKind::kAlpha:
      return object.find_radians("alpha", kNotNegative);
    case calib::ParameterKind::kD:
      return object.find_metres("d", kNotNegative);
    case calib::ParameterKind::kTheta:
      return object.find_radians("theta", kNotNegative);
    case calib::ParameterKind::kR:
      return object.find_metres("r", kNotNegative);
    case calib::ParameterKind::kBeta:
      return object.find_radians("beta", kNotNegative);
  }
  return std::nullopt;
}

void read_standard_deviations(const JsonObject& frame_object, int frame, Arm& arm) {
  std::optional<JsonObject> given;
  if (const auto value = frame_object.find("std")) {
    given = frame == 0 ? value->object({"theta_deg", "theta_rad", "r_mm"})
                       : value->object({"alpha_deg", "alpha_rad", "d_mm", "theta_deg", "theta_rad", "r_mm",
                                        "beta_deg", "beta_rad"});
  }
  const auto& parameters = calib::error_parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].frame != frame) continue;
    arm.std_errors[i] = given ? std_of(*given, parameters[i].kind) : std::nullopt;
  }
}

void read_joint_ranges(const JsonObject& object, Arm& arm) {
  const calib::JointVector units = joint_units(arm.model);
  const auto ranges = object.at("joint_limits_deg").items(kJointCount, kJointCount);
  for (int joint = 0; joint < kJointCount; ++joint) {
    const JsonValue& range = ranges[static_cast<std::size_t>(joint)];
    const Eigen::Vector2d limits = range.numbers<2>() * units[joint];
    if (limits[0] >= limits[1])
      range.fail("the lower limit is not below the upper one; exchange or correct them");
    arm.joint_ranges.lower[joint] = limits[0];
    arm.joint_ranges.upper[joint] = limits[1];
  }
  const auto speeds = object.at("joint_max_speeds_deg_s").items(kJointCount, kJointCount);
  for (int joint = 0; joint < kJointCount; ++joint) {
    arm.joint_speeds_max[joint] = speeds[static_cast<std::size_t>(joint)].number(kPositive) * units[joint];
  }
}

/// Weights turn with joint 1, so that only an arm whose axis 1 is plumb has a fixed "down" in frame 1.
Eigen::Vector3d down_from_json(const JsonValue& value) {
  Eigen::Vector3d down = value.numbers<3>();
  if (down.x() != 0.0 || down.y() != 0.0 || std::abs(down.z()) != 1.0) {
    value.fail("is not along joint 1's axis; give [0,0,-1] (axis 1 points up) or [0,0,1]");
  }
  return down;
}

void read_masses(const JsonValue& value, calib::KinematicModel& model) {
  int last_frame = 0;
  for (const JsonValue& item : value.items(1, kFrameCount - 1)) {
    const JsonObject object = item.object({"frame", "mass_kg", "center_mm"});
    const JsonValue frame = object.at("frame");
    const int number = frame.integer(1, kFrameCount - 1);
    if (number <= last_frame) frame.fail("frames stand in order, each once; exchange or sum up the masses");
    last_frame = number;
    model.masses[static_cast<std::size_t>(number)] = {
        .mass_kg = object.at("mass_kg").number(kPositive),
        .center_in_frame_m = object.at("center_mm").numbers<3>() * calib::kMetresPerMillimetre};
  }
}

void demand_compliant_joints_turn(const JsonObject& gravity, const calib::KinematicModel& model) {
  for (const int joint : calib::kCompliantJoints) {
    if (model.joint_types[static_cast<std::size_t>(joint)] == calib::JointType::kRevolute) continue;
    gravity.fail("joint " + std::to_string(joint + 1) +
                 " is prismatic, a moment does not bend it; leave \"gravity\" out");
  }
}

void read_gravity(const JsonValue& value, Arm& arm) {
  const JsonObject object =
      value.object({"down_in_frame_1", "masses", "compliance_rad_per_nm", "std_compliance_rad_per_nm"});
  demand_compliant_joints_turn(object, arm.model);
  arm.model.down_in_frame_1 = down_from_json(object.at("down_in_frame_1"));
  read_masses(object.at("masses"), arm.model);
  const auto compliances = object.find("compliance_rad_per_nm");
  const auto deviations = object.find("std_compliance_rad_per_nm");
  for (std::size_t i = 0; i < calib::kComplianceCount; ++i) {
    const auto joint = static_cast<std::size_t>(calib::kCompliantJoints[i]);
    if (compliances)
      arm.model.compliance_rad_per_nm[joint] =
          compliances->items(calib::kComplianceCount, calib::kComplianceCount)[i].number(kCompliances);
    if (deviations)
      arm.std_compliance_rad_per_nm[i] =
          deviations->items(calib::kComplianceCount, calib::kComplianceCount)[i].number(
              {.min = kPositive.min, .max = kCompliances.max});
  }
}

}  // namespace

int frame_number(const JsonValue& value) {
  for (const auto& [key, member] : value.members()) {
    if (key == "j") return member.integer(0, kFrameCount - 1);
  }
  value.fail("\"j\" is missing; add the frame's number");
}

void read_frame(const JsonValue& value, int frame, Arm& arm) {
  const JsonObject object = frame_object(value, frame);
  calib::LinkParameters link;
  link.r_m = object.metres("r");
  link.theta_rad = object.radians(is_joint(frame) ? "theta_offset" : "theta");
  if (frame > 0) {
    link.alpha_rad = object.radians("alpha");
    link.d_m = object.metres("d");
    link.beta_rad = object.radians("beta");
  }
  if (is_joint(frame)) read_joint(object, frame, arm.model);
  arm.model.links[static_cast<std::size_t>(frame)] = link;
  read_standard_deviations(object, frame, arm);
}

Arm read_arm(const std::filesystem::path& file) {
  const std::string source = file.string();
  const nlohmann::json document = read_json_file(file);
  const JsonObject object = JsonValue(source, document)
                                .document(kArmSchema, {"schema", "name", "frames", "joint_limits_deg",
                                                       "joint_max_speeds_deg_s", "gravity", "bodies"});
  Arm arm;
  arm.name = object.at("name").text();
  const auto frames = object.at("frames").items(kFrameCount, kFrameCount);
  for (int frame = 0; frame < kFrameCount; ++frame) {
    const JsonValue& value = frames[static_cast<std::size_t>(frame)];
    if (const int given = frame_number(value); given != frame) {
      value.fail("is frame " + std::to_string(given) + " where frame " + std::to_string(frame) +
                 " is expected; put frames 0 to 7 in order");
    }
    read_frame(value, frame, arm);
  }
  read_joint_ranges(object, arm);
  if (const auto gravity = object.find("gravity")) read_gravity(*gravity, arm);
  arm.bodies = capsules_from_json(object.at("bodies"));
  return arm;
}

}  // namespace cell
