#include "config/truth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/schema_version.hpp"

namespace cell {
namespace {

constexpr std::array kTruthSchemas{kRigidTruthSchema, kSecondTruthSchema, kThirdTruthSchema, kTruthSchema};
/// Joints 2 and 3 of a file.
constexpr std::size_t kDroopingJoints = 2;
constexpr NumberRange kDroopCompliances{.min = 0.0, .max = 1e-4};
constexpr NumberRange kSmallAngles{.min = 0.0, .max = 0.01};
constexpr NumberRange kPeriods{.min = 0.0, .max = 10'000.0};
/// A ripple's steepest share of the joint's own motion; with more a joint would all but stand still.
constexpr double kRippleSlopeMax = 0.1;
constexpr NumberRange kExpansions{0.0, 1e-3};
constexpr NumberRange kKelvins{-50.0, 50.0};
constexpr NumberRange kTimeConstants{1.0, 1e6};
constexpr NumberRange kFaceOffsetsMm{-10.0, 10.0};
constexpr double kSphereShiftMaxMm = 10.0;
constexpr double kBoreTurnMaxRadians = 0.05;
/// A place that is farther off is another one.
constexpr double kPlaceShiftMaxMm = 50.0;
constexpr double kPlaceTurnMaxRadians = 0.05;
/// A tip that is farther off is another one: "within_mm" of a probe's file is not more.
constexpr double kTipShiftMaxMm = 5.0;
constexpr NumberRange kProbePartsMm{-1.0, 1.0};
constexpr NumberRange kNoiseMm{0.0, 1.0};
constexpr std::size_t kOffsetCountMax = 100;
/// A face belongs to the side of a solid that it lies on to this much.
constexpr double kSameSideMetres = 1e-6;

/// "r0_mm", "theta0_rad" or "theta0_deg"; the error goes in SI units into its place.
int read_error(const std::string& key, const JsonValue& value, calib::ErrorVector& errors) {
  const std::size_t underscore = key.find('_');
  const std::string name = key.substr(0, underscore);
  const std::string unit = underscore == std::string::npos ? "" : key.substr(underscore + 1);
  const std::optional<int> index = calib::error_parameter_index(name);
  if (!index) value.fail("unknown error " + in_quotes(key) + R"(; give names such as "r0_mm", "theta0_rad")");
  const bool is_length = calib::error_parameters()[static_cast<std::size_t>(*index)].is_length();
  if (is_length ? unit != "mm" : unit != "rad" && unit != "deg") {
    value.fail("the unit is not in the name; write " + in_quotes(name + (is_length ? "_mm" : "_rad")));
  }
  const double number = value.number();
  errors[*index] = unit == "mm"    ? calib::metres_from_mm(number)
                   : unit == "deg" ? calib::radians_from_degrees(number)
                                   : number;
  return *index;
}

void read_errors(const JsonValue& value, calib::ErrorVector& errors) {
  std::set<int> given;
  for (const auto& [key, member] : value.members()) {
    if (!given.insert(read_error(key, member, errors)).second) {
      member.fail("this error is given in two units; keep one of them");
    }
  }
}

calib::JointVector six(const JsonValue& value, const NumberRange& range) {
  calib::JointVector numbers;
  const auto items = value.items(calib::kJointCount, calib::kJointCount);
  for (int i = 0; i < calib::kJointCount; ++i) numbers[i] = items[static_cast<std::size_t>(i)].number(range);
  return numbers;
}

void read_droop(const JsonObject& object, Truth& truth) {
  Droop& droop = truth.droop.emplace();
  const auto compliances = object.at("compliance_rad_per_nm").items(kDroopingJoints, kDroopingJoints);
  for (std::size_t i = 0; i < kDroopingJoints; ++i)
    droop.compliance_rad_per_nm[i + 1] = compliances[i].number(kDroopCompliances);
}

void read_ripple(const JsonObject& object, Truth& truth) {
  const auto joints = object.at("joints").items(calib::kJointCount, calib::kJointCount);
  for (std::size_t i = 0; i < calib::kJointCount; ++i) {
    const JsonObject joint =
        joints[i].object({"amplitude_rad", "periods_per_turn", "phase_deg", "phase_rad"});
    Ripple& ripple = truth.ripple[i];
    ripple.amplitude_rad = joint.at("amplitude_rad").number(kSmallAngles);
    ripple.periods_per_turn = joint.at("periods_per_turn").number(kPeriods);
    ripple.phase_rad = joint.radians("phase");
    if (ripple.amplitude_rad * ripple.periods_per_turn > kRippleSlopeMax)
      joints[i].fail("amplitude x periods is over " + plain_number(kRippleSlopeMax) +
                     "; no gear is as uneven");
  }
}

void read_backlash(const JsonObject& object, Truth& truth) {
  truth.backlash_rad = six(object.at("width_rad"), kSmallAngles);
}

void read_thermal(const JsonObject& object, Truth& truth) {
  truth.warming = {.arm_expansion_per_k = object.at("arm_expansion_per_k").number(kExpansions),
                   .arm_rise_k = object.at("arm_rise_k").number(kKelvins),
                   .arm_time_constant_s = object.at("arm_time_constant_s").number(kTimeConstants),
                   .block_warmer_k = object.at("block_warmer_k").number(kKelvins)};
}

void read_block_offsets(const JsonObject& object, Truth& truth) {
  for (const JsonValue& item : object.at("offsets_mm").items(1, kOffsetCountMax))
    truth.face_offsets_m.push_back(calib::metres_from_mm(item.number(kFaceOffsetsMm)));
  const auto read_vectors = [&](const char* key, double most, double factor, const char* remedy,
                                std::vector<Eigen::Vector3d>& vectors) {
    const auto given = object.find(key);
    if (!given) return;
    for (const JsonValue& item : given->items(1, kOffsetCountMax)) {
      const Eigen::Vector3d vector = item.numbers<3>();
      if (vector.cwiseAbs().maxCoeff() > most) item.fail("is over " + plain_number(most) + remedy);
      vectors.emplace_back(vector * factor);
    }
  };
  read_vectors("sphere_shifts_mm", kSphereShiftMaxMm, calib::kMetresPerMillimetre,
               " mm; give where the sphere nearly is", truth.sphere_shifts_m);
  read_vectors("bore_shifts_mm", kSphereShiftMaxMm, calib::kMetresPerMillimetre,
               " mm; give where the bore nearly is", truth.bore_shifts_m);
  read_vectors("bore_turns_rad", kBoreTurnMaxRadians, 1.0, " rad; give how the bore nearly lies",
               truth.bore_turns_rad);
}

void read_true_probe(const JsonObject& object, Truth& truth) {
  TrueProbe& probe = truth.probe;
  probe.stylus_radius_m = object.find_metres("stylus_radius", kNotNegative);
  probe.pretravel_m = object.find_metres("pretravel", kProbePartsMm);
  probe.pretravel_tilt_m = object.find_metres("pretravel_tilt", kProbePartsMm).value_or(0.0);
  probe.lobes_m = object.find_metres("lobes", kProbePartsMm).value_or(0.0);
  probe.lobe_direction_rad = object.find_radians("lobe_direction").value_or(0.0);
  probe.noise_m = object.find_metres("noise", kNoiseMm);
}

void read_repeatability(const JsonObject& object, Truth& truth) {
  truth.repeatability_rad = six(object.at("std_rad"), kSmallAngles);
}

void read_encoder(const JsonObject& object, Truth& truth) {
  constexpr NumberRange kSteps{.min = 0.0, .max = 1.0};
  truth.encoder_step_rad = object.find_radians("step", kSteps).value_or(0.0);
}

/// An effect as it stands in the file under its name. It is read whether it is on or not.
void read_effect(const JsonObject& document, std::string_view name,
                 std::initializer_list<std::string_view> known_keys, void (*read)(const JsonObject&, Truth&),
                 Truth& truth) {
  const auto value = document.find(name);
  if (!value) return;
  const JsonObject object = value->object(known_keys);
  const auto on = object.find("on");
  Truth with_it = truth;
  read(object, with_it);
  if (!on || on->boolean()) truth = std::move(with_it);
}

void read_effects(const JsonObject& object, Truth& truth) {
  read_effect(object, "droop", {"on", "compliance_rad_per_nm"}, read_droop, truth);
  read_effect(object, "ripple", {"on", "joints"}, read_ripple, truth);
  read_effect(object, "backlash", {"on", "width_rad"}, read_backlash, truth);
  read_effect(object, "thermal",
              {"on", "arm_expansion_per_k", "arm_rise_k", "arm_time_constant_s", "block_warmer_k"},
              read_thermal, truth);
  read_effect(object, "block", {"on", "offsets_mm", "sphere_shifts_mm", "bore_shifts_mm", "bore_turns_rad"},
              read_block_offsets, truth);
  read_effect(object, "probe",
              {"on", "stylus_radius_mm", "pretravel_mm", "pretravel_tilt_mm", "lobes_mm",
               "lobe_direction_deg", "lobe_direction_rad", "noise_mm"},
              read_true_probe, truth);
  read_effect(object, "repeatability", {"on", "std_rad"}, read_repeatability, truth);
  read_effect(object, "encoder", {"on", "step_deg", "step_rad"}, read_encoder, truth);
}

/// A vector that is at most so long; nothing is none.
Eigen::Vector3d short_vector(const JsonObject& object, const char* key, double most, const char* remedy) {
  const auto given = object.find(key);
  if (!given) return Eigen::Vector3d::Zero();
  Eigen::Vector3d vector = given->numbers<3>();
  if (vector.norm() > most) given->fail("is over " + plain_number(most) + remedy);
  return vector;
}

TruePlace true_place_from_json(const std::string& name, const JsonValue& value) {
  const JsonObject object = value.object({"shift_mm", "turn_rad"});
  return {.name = name,
          .shift_m = calib::kMetresPerMillimetre * short_vector(object, "shift_mm", kPlaceShiftMaxMm,
                                                                " mm; give where the place nearly is"),
          .turn_rad =
              short_vector(object, "turn_rad", kPlaceTurnMaxRadians, " rad; give where the place nearly is")};
}

TrueTip true_tip_from_json(const std::string& name, const JsonValue& value) {
  const JsonObject object = value.object({"shift_mm", "radius_mm"});
  return {.name = name,
          .shift_m = calib::kMetresPerMillimetre *
                     short_vector(object, "shift_mm", kTipShiftMaxMm, " mm; give where the ball nearly is"),
          .radius_m = object.find_metres("radius", kPositive)};
}

/// An effect whose keys are names of places or tips.
template <class Named>
std::vector<Named> named_effect(const JsonValue& value,
                                Named (*from_json)(const std::string&, const JsonValue&)) {
  bool on = true;
  std::vector<Named> all;
  for (const auto& [key, member] : value.members()) {
    if (key == "on") {
      on = member.boolean();
    } else {
      all.push_back(from_json(key, member));
    }
  }
  return on ? all : std::vector<Named>{};
}

/// The ball of a sphere among the block's solids: read_block() puts it there.
calib::Box& ball_of(const calib::Face& sphere, std::vector<calib::Box>& solids) {
  const auto is_it = [&](const calib::Box& solid) {
    return solid.round_m > 0.0 && (solid.min_m - sphere.cap->center_m).norm() < kSameSideMetres;
  };
  return *std::ranges::find_if(solids, is_it);
}

/// The hole of a bore: read_block() puts it into its solid.
calib::Hole& hole_of(const calib::Face& bore, std::vector<calib::Box>& solids) {
  for (calib::Box& solid : solids) {
    for (calib::Hole& hole : solid.holes)
      if ((hole.center_m - bore.bore->center_m).norm() < kSameSideMetres) return hole;
  }
  throw std::logic_error("hole_of: the bore is in no solid of its block");
}

/// Moves the side of a solid that the face lies on, or grows the ball, or narrows the hole; false when there
/// is none.
bool move_side(const calib::Face& face, double offset_m, std::vector<calib::Box>& solids) {
  if (face.cap) {
    ball_of(face, solids).round_m += offset_m;
    return true;
  }
  if (face.bore) {
    hole_of(face, solids).radius_m -= offset_m;
    return true;
  }
  int axis = 0;
  face.plane.outward.cwiseAbs().maxCoeff(&axis);
  const bool outward_is_up = face.plane.outward[axis] > 0.0;
  for (calib::Box& solid : solids) {
    const double beyond_m = (solid.min_m - face.center_m).cwiseMax(face.center_m - solid.max_m).maxCoeff();
    double& side_m = outward_is_up ? solid.max_m[axis] : solid.min_m[axis];
    if (std::abs(side_m - face.center_m[axis]) > kSameSideMetres || beyond_m > kSameSideMetres) continue;
    side_m += outward_is_up ? offset_m : -offset_m;
    return true;
  }
  return false;
}

/// One of the vectors for each of the things, or none at all.
void demand_one_each(const Truth& truth, const char* key, std::size_t given, const char* of_what,
                     std::size_t things) {
  if (given == 0 || given == things) return;
  throw ConfigError(truth.file.string(), std::string("/block/") + key,
                    "has " + std::to_string(given) + " shifts, the block has " + std::to_string(things) +
                        " " + of_what + "s; give one a " + of_what);
}

void move_spheres(const Truth& truth, const Block& block, std::vector<calib::Box>& solids) {
  std::vector<calib::Box*> balls;
  for (const calib::Face& face : block.faces)
    if (face.cap) balls.push_back(&ball_of(face, solids));
  demand_one_each(truth, "sphere_shifts_mm", truth.sphere_shifts_m.size(), "sphere", balls.size());
  for (std::size_t i = 0; i < truth.sphere_shifts_m.size(); ++i) {
    balls[i]->min_m += truth.sphere_shifts_m[i];
    balls[i]->max_m += truth.sphere_shifts_m[i];
  }
}

/// Each about the middle of its wall.
void move_bores(const Truth& truth, const Block& block, std::vector<calib::Box>& solids) {
  std::vector<calib::Hole*> holes;
  for (const calib::Face& face : block.faces)
    if (face.bore) holes.push_back(&hole_of(face, solids));
  demand_one_each(truth, "bore_shifts_mm", truth.bore_shifts_m.size(), "bore", holes.size());
  demand_one_each(truth, "bore_turns_rad", truth.bore_turns_rad.size(), "bore", holes.size());
  for (std::size_t i = 0; i < truth.bore_turns_rad.size(); ++i) {
    const Eigen::Vector3d& turn_rad = truth.bore_turns_rad[i];
    if (turn_rad.isZero(0.0)) continue;
    holes[i]->axis = Eigen::AngleAxisd(turn_rad.norm(), turn_rad.normalized()) * holes[i]->axis;
  }
  for (std::size_t i = 0; i < truth.bore_shifts_m.size(); ++i) holes[i]->center_m += truth.bore_shifts_m[i];
}

}  // namespace

Truth read_truth(const std::filesystem::path& file) {
  const std::string source = file.string();
  const nlohmann::json json = read_json_file(file);
  const JsonValue document(source, json);
  const SchemaVersion version = schema_version(json, "truth", kTruthSchemas);
  const bool rigid = version.number == 1;
  const JsonObject object =
      rigid ? document.document(kRigidTruthSchema, {"schema", "name", "errors"})
            : document.document(kTruthSchemas[static_cast<std::size_t>(version.number) - 1],
                                {"schema", "name", "errors", "droop", "ripple", "backlash", "thermal",
                                 "block", "places", "tips", "probe", "repeatability", "encoder"});
  Truth truth;
  truth.name = object.at("name").text();
  truth.file = file;
  read_errors(object.at("errors"), truth.errors);
  if (rigid) return truth;
  read_effects(object, truth);
  if (const auto places = find_since(3, object, "places", version))
    truth.places = named_effect(*places, true_place_from_json);
  if (const auto tips = find_since(4, object, "tips", version))
    truth.tips = named_effect(*tips, true_tip_from_json);
  return truth;
}

std::vector<calib::Box> true_solids(const Truth& truth, const Block& block) {
  std::vector<calib::Box> solids = block.solids;
  if (!truth.face_offsets_m.empty() && truth.face_offsets_m.size() != block.faces.size()) {
    throw ConfigError(truth.file.string(), "/block/offsets_mm",
                      "has " + std::to_string(truth.face_offsets_m.size()) + " numbers, the block has " +
                          std::to_string(block.faces.size()) + " planes; give one a plane");
  }
  for (std::size_t i = 0; i < truth.face_offsets_m.size(); ++i) {
    if (move_side(block.faces[i], truth.face_offsets_m[i], solids)) continue;
    throw ConfigError(
        truth.file.string(), "/block/offsets_mm/" + std::to_string(i),
        "plane " + std::to_string(i + 1) + " lies on no side of the block's solids; leave \"block\" out");
  }
  move_spheres(truth, block, solids);
  move_bores(truth, block, solids);
  const double growth = 1.0 + block.thermal_expansion_per_k.value_or(0.0) * true_warmth_k(truth, block);
  for (calib::Box& solid : solids) {
    solid.min_m *= growth;
    solid.max_m *= growth;
    solid.round_m *= growth;
    for (calib::Hole& hole : solid.holes) {
      hole.center_m *= growth;
      hole.radius_m *= growth;
    }
  }
  return solids;
}

double true_warmth_k(const Truth& truth, const Block& block) {
  constexpr double kReferenceCelsius = 20.0;
  return block.temperature_c.value_or(kReferenceCelsius) - kReferenceCelsius + truth.warming.block_warmer_k;
}

calib::KinematicModel true_model(const Truth& truth, const Arm& arm) {
  calib::KinematicModel model = calib::apply(arm.model, truth.errors);
  if (truth.harmonics_rad) model.harmonics_rad = *truth.harmonics_rad;
  for (std::size_t joint = 0; joint < calib::kJointCount; ++joint)  // in place of the arm file's
    if (truth.ripple[joint].amplitude_rad > 0.0) model.ripples_rad[joint] = {0.0, 0.0};
  if (!truth.droop) return model;
  const auto has_mass = [](const calib::PointMass& mass) { return mass.mass_kg != 0.0; };
  if (std::ranges::none_of(model.masses, has_mass)) {
    throw ConfigError(
        truth.file.string(), "/droop",
        "the arm " + in_quotes(arm.name) + " has no masses; give its file \"gravity\" or leave this out");
  }
  model.compliance_rad_per_nm = truth.droop->compliance_rad_per_nm;
  return model;
}

}  // namespace cell
