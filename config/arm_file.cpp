#include "config/arm_file.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/arm_uncertainty.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/joint_units.hpp"
#include "config/serial_number.hpp"
#include "config/shapes.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

using calib::kFrameCount;
using calib::kJointCount;

constexpr NumberRange kGains{.min = -1000.0, .max = 1000.0};
constexpr double kGainSizeMin = 1e-3;
/// rad/Nm; at the bounds 100 Nm turn a joint by 6 degrees. An identified one may be a little under 0, and ten
/// times what a soft arm has where touches hardly show it: what was exported is read again.
constexpr NumberRange kCompliances{.min = -1e-3, .max = 1e-3};
/// A joint of an arm that is worth calibrating does not yield more.
constexpr NumberRange kComplianceDeviations{.min = 0.0, .max = 1e-4};

/// A unit vector in a file may be this much longer or shorter.
constexpr double kUnitVectorError = 1e-6;
/// Of a joint's drive, radians.
constexpr NumberRange kGearAngles{.min = 0.0, .max = 0.01};
constexpr NumberRange kHarmonics{.min = -0.01, .max = 0.01};
/// Of ripple, a turn of the joint: one period is the first harmonic.
constexpr NumberRange kGearPeriods{.min = 2.0, .max = 10'000.0};
/// A ripple's steepest share of the joint's own motion; with more a joint would all but stand still.
constexpr double kGearSlopeMax = 0.1;
constexpr NumberRange kMassShares{.min = kPositive.min, .max = 1.0};

/// Joints that a list of two compliances is for: those that carry the weight of an arm on the floor.
constexpr std::array<std::size_t, 2> kPairJoints{1, 2};

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

Eigen::Vector3d down_from_json(const JsonValue& value) {
  const Eigen::Vector3d down = value.numbers<3>();
  if (std::abs(down.norm() - 1.0) > kUnitVectorError) {
    value.fail("has the length " + plain_number(down.norm()) +
               "; give a unit vector, [0,0,-1] where axis 1 points up");
  }
  return down.normalized();
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

void demand_no_prismatic_joint(const JsonObject& gravity, const calib::KinematicModel& model) {
  for (const std::size_t joint : kPairJoints) {
    if (model.joint_types[joint] == calib::JointType::kRevolute) continue;
    gravity.fail("joint " + std::to_string(joint + 1) +
                 " is prismatic, a moment does not bend it; leave \"gravity\" out");
  }
}

/// Six values, or two for joints 2 and 3.
std::vector<std::pair<std::size_t, JsonValue>> of_compliant_joints(const JsonValue& value) {
  const auto items = value.items(kPairJoints.size(), kJointCount);
  const bool is_pair = items.size() == kPairJoints.size();
  if (!is_pair && items.size() != kJointCount) {
    value.fail("has " + std::to_string(items.size()) + " values; give two (joints 2 and 3) or six");
  }
  std::vector<std::pair<std::size_t, JsonValue>> joints;
  for (std::size_t i = 0; i < items.size(); ++i) joints.emplace_back(is_pair ? kPairJoints[i] : i, items[i]);
  return joints;
}

bool are_all_zero(const std::optional<JsonValue>& values) {
  if (!values) return true;
  const auto joints = of_compliant_joints(*values);
  return std::ranges::all_of(joints,
                             [](const auto& joint) { return joint.second.number(kCompliances) == 0.0; });
}

/// Zeros for all joints say as little of the droop as nothing at all: an arm that does not yield needs no
/// masses.
void demand_compliance(const JsonObject& object, const std::optional<JsonValue>& compliances,
                       const std::optional<JsonValue>& deviations) {
  if (!are_all_zero(compliances) || !are_all_zero(deviations)) return;
  object.at("masses").fail(
      "masses without a compliance: the droop would be neither in the model nor in an uncertainty; add "
      "\"std_compliance_rad_per_nm\" beside them (0 for a joint that does not yield, over 0 for at least "
      "one), or leave \"gravity\" out");
}

void read_gravity(const JsonValue& value, bool is_first_schema, Arm& arm) {
  const JsonObject object =
      is_first_schema
          ? value.object({"down_in_frame_1", "masses", "compliance_rad_per_nm", "std_compliance_rad_per_nm"})
          : value.object({"down_in_frame_1", "masses", "compliance_rad_per_nm", "std_compliance_rad_per_nm",
                          "std_mass_share"});
  demand_no_prismatic_joint(object, arm.model);
  arm.model.down_in_frame_1 = down_from_json(object.at("down_in_frame_1"));
  read_masses(object.at("masses"), arm.model);
  const auto compliances = object.find("compliance_rad_per_nm");
  const auto deviations = object.find("std_compliance_rad_per_nm");
  demand_compliance(object, compliances, deviations);
  if (compliances) {
    for (const auto& [joint, item] : of_compliant_joints(*compliances))
      arm.model.compliance_rad_per_nm[joint] = item.number(kCompliances);
  }
  if (deviations) {
    for (const auto& [joint, item] : of_compliant_joints(*deviations)) {
      const double std = item.number(kComplianceDeviations);
      if (std > 0.0)
        arm.nongeometric_std[static_cast<std::size_t>(calib::compliance_position(static_cast<int>(joint)))] =
            std;
    }
  }
  if (is_first_schema) return;
  if (const auto share = object.find("std_mass_share")) {
    for (int frame = 1; frame < kFrameCount; ++frame) {
      if (arm.model.masses[static_cast<std::size_t>(frame)].mass_kg > 0.0)
        arm.nongeometric_std[static_cast<std::size_t>(calib::mass_position(frame))] =
            share->number(kMassShares);
    }
  }
}

calib::JointVector gear_angles(const JsonObject& object, std::string_view key) {
  calib::JointVector angles = calib::JointVector::Zero();
  const auto value = object.find(key);
  if (!value) return angles;
  const auto items = value->items(kJointCount, kJointCount);
  for (std::size_t i = 0; i < items.size(); ++i)
    angles[static_cast<Eigen::Index>(i)] = items[i].number(kGearAngles);
  return angles;
}

std::array<calib::CosSin, kJointCount> cosines_and_sines(const JsonValue& value) {
  std::array<calib::CosSin, kJointCount> pairs;
  const auto items = value.items(kJointCount, kJointCount);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const auto pair = items[joint].items(2, 2);
    pairs[joint] = {pair[0].number(kHarmonics), pair[1].number(kHarmonics)};
  }
  return pairs;
}

/// The period of one joint's ripple, with the deviation of its cosine and sine from the amplitude.
void read_period(const JsonValue& value, int joint, Arm& arm) {
  const auto index = static_cast<std::size_t>(joint);
  if (arm.model.joint_types[index] == calib::JointType::kPrismatic)
    value.fail("joint " + std::to_string(joint + 1) + " is prismatic and has no turn; give null");
  const double periods = value.number(kAnyNumber);
  if (!(periods >= kGearPeriods.min && periods <= kGearPeriods.max)) {
    value.fail(
        "is " + plain_number(periods) + "; give " + plain_number(kGearPeriods.min) + " to " +
        plain_number(kGearPeriods.max) +
        R"( (one period a turn is the first harmonic, "std_harmonic_rad"), or null where it is unknown)");
  }
  const double amplitude_rad = arm.gears.ripple_rad[joint];
  if (amplitude_rad == 0.0) {
    value.fail("has no amplitude; give /gears/ripple_rad/" + std::to_string(joint) +
               " over 0, or null for the period");
  }
  if (amplitude_rad * periods > kGearSlopeMax) {
    value.fail("times the amplitude in /gears/ripple_rad/" + std::to_string(joint) + " is over " +
               plain_number(kGearSlopeMax) + "; no gear is as uneven, correct one of them");
  }
  arm.model.ripple_periods_per_turn[index] = periods;
  const auto cosine = static_cast<std::size_t>(calib::ripple_position(joint));
  arm.nongeometric_std[cosine] = arm.nongeometric_std[cosine + 1] = amplitude_rad / std::sqrt(2.0);
}

/// After the amplitudes.
void read_ripple(const JsonObject& object, Arm& arm) {
  const auto periods = object.find("ripple_periods_per_turn");
  if (periods) {
    const auto items = periods->items(kJointCount, kJointCount);
    for (int joint = 0; joint < kJointCount; ++joint) {
      const JsonValue& item = items[static_cast<std::size_t>(joint)];
      if (!item.is_null()) read_period(item, joint, arm);
    }
  }
  const auto known = object.find("ripples_rad");
  if (!known) return;
  const auto pairs = cosines_and_sines(*known);
  const auto items = known->items(kJointCount, kJointCount);
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    const bool is_even = pairs[joint].cos == 0.0 && pairs[joint].sin == 0.0;
    if (!is_even && arm.model.ripple_periods_per_turn[joint] == 0.0)
      items[joint].fail("has no period; give it in /gears/ripple_periods_per_turn, or 0, 0");
    const double slope =
        std::hypot(pairs[joint].cos, pairs[joint].sin) * arm.model.ripple_periods_per_turn[joint];
    if (slope > kGearSlopeMax)
      items[joint].fail("times its period is over " + plain_number(kGearSlopeMax) + "; no gear is as uneven");
  }
  arm.model.ripples_rad = pairs;
}

void read_gears(const JsonValue& value, bool has_periods, Arm& arm) {
  const JsonObject object =
      has_periods
          ? value.object({"harmonics_rad", "std_harmonic_rad", "ripple_rad", "ripple_periods_per_turn",
                          "ripples_rad", "backlash_rad", "repeatability_rad"})
          : value.object(
                {"harmonics_rad", "std_harmonic_rad", "ripple_rad", "backlash_rad", "repeatability_rad"});
  arm.gears = {.ripple_rad = gear_angles(object, "ripple_rad"),
               .backlash_rad = gear_angles(object, "backlash_rad"),
               .repeatability_rad = gear_angles(object, "repeatability_rad")};
  if (has_periods) read_ripple(object, arm);
  if (const auto harmonics = object.find("harmonics_rad"))
    arm.model.harmonics_rad = cosines_and_sines(*harmonics);
  if (const auto std = object.find("std_harmonic_rad")) {
    for (int joint = 0; joint < kJointCount; ++joint) {
      if (arm.model.joint_types[static_cast<std::size_t>(joint)] == calib::JointType::kPrismatic) continue;
      const auto cosine = static_cast<std::size_t>(calib::harmonic_position(joint));
      const auto second = static_cast<std::size_t>(calib::second_harmonic_position(joint));
      arm.nongeometric_std[cosine] = arm.nongeometric_std[cosine + 1] = arm.nongeometric_std[second] =
          arm.nongeometric_std[second + 1] = std->number({.min = kPositive.min, .max = kGearAngles.max});
    }
  }
}

Growth growth_from_json(const JsonValue& value) {
  const JsonObject object = value.object({"expansion_per_k", "rise_k"});
  return {.expansion_per_k = object.at("expansion_per_k").number({.min = kPositive.min, .max = 1e-3}),
          .rise_k = object.at("rise_k").number({.min = kPositive.min, .max = 100.0})};
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

namespace {

/// The keys that the document's schema has.
JsonObject arm_object(const JsonValue& value, const nlohmann::json& document) {
  if (has_schema(document, kFirstArmSchema))
    return value.document(kFirstArmSchema, {"schema", "name", "frames", "joint_limits_deg",
                                            "joint_max_speeds_deg_s", "gravity", "bodies"});
  for (const std::string_view earlier : {kSecondArmSchema, kThirdArmSchema})
    if (has_schema(document, earlier))
      return value.document(earlier, {"schema", "name", "frames", "joint_limits_deg",
                                      "joint_max_speeds_deg_s", "gravity", "gears", "warming", "bodies"});
  if (has_schema(document, kFourthArmSchema))
    return value.document(kFourthArmSchema,
                          {"schema", "name", "frames", "joint_limits_deg", "joint_max_speeds_deg_s",
                           "gravity", "gears", "warming", "uncertainty", "bodies"});
  return value.document(kArmSchema,
                        {"schema", "name", "serial", "frames", "joint_limits_deg", "joint_max_speeds_deg_s",
                         "gravity", "gears", "warming", "uncertainty", "bodies"});
}

Arm arm_from_document(const std::string& source, const nlohmann::json& document) {
  const JsonValue value(source, document);
  const bool is_first_schema = has_schema(document, kFirstArmSchema);
  const bool is_second_schema = has_schema(document, kSecondArmSchema);
  const JsonObject object = arm_object(value, document);
  Arm arm;
  arm.name = object.at("name").text();
  const auto frames = object.at("frames").items(kFrameCount, kFrameCount);
  for (int frame = 0; frame < kFrameCount; ++frame) {
    const JsonValue& entry = frames[static_cast<std::size_t>(frame)];
    if (const int given = frame_number(entry); given != frame) {
      entry.fail("is frame " + std::to_string(given) + " where frame " + std::to_string(frame) +
                 " is expected; put frames 0 to 7 in order");
    }
    read_frame(entry, frame, arm);
  }
  read_joint_ranges(object, arm);
  if (const auto gravity = object.find("gravity")) read_gravity(*gravity, is_first_schema, arm);
  if (!is_first_schema) {
    if (const auto gears = object.find("gears")) read_gears(*gears, !is_second_schema, arm);
    if (const auto warming = object.find("warming")) arm.growth = growth_from_json(*warming);
  }
  const bool is_newest = has_schema(document, kArmSchema);
  if (is_newest) arm.serial = serial_number(object.find("serial"));
  if (is_newest || has_schema(document, kFourthArmSchema))
    if (const auto found = object.find("uncertainty")) arm.covariance = arm_covariance_from_json(*found);
  arm.bodies = capsules_from_json(object.at("bodies"));
  return arm;
}

}  // namespace

Arm read_arm(const std::filesystem::path& file) {
  return arm_from_document(file.string(), read_json_file(file));
}

Arm read_arm_text(const std::string& source, std::string_view text) {
  return arm_from_document(source, parse_strict_json(source, text, kConfigFileSizeMax));
}

}  // namespace cell
