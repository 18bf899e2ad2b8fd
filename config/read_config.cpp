#include "config/read_config.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/motion_time.hpp"
#include "config/arm_file.hpp"
#include "config/block_file.hpp"
#include "config/file_bytes.hpp"
#include "config/joint_units.hpp"
#include "config/json_value.hpp"
#include "config/probe_file.hpp"
#include "config/recipe_file.hpp"
#include "config/schema_version.hpp"
#include "config/serial_number.hpp"
#include "config/shapes.hpp"
#include "config/targets_file.hpp"

namespace cell {
namespace {

using calib::metres_from_mm;

constexpr std::size_t kRecipeCountMax = 100;

/// A file that the cell names; that it is there is the cell file's promise.
std::filesystem::path named_file(const JsonValue& value, Cell& cell) {
  std::filesystem::path file = (cell.file.parent_path() / value.text()).lexically_normal();
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    value.fail("there is no file " + in_quotes(file.string()) +
               "; correct the path (relative to the cell file)");
  }
  cell.files.push_back(file);
  return file;
}

/// An arm that was calibrated and exported is that of one robot.
void demand_own_arm(const JsonObject& object, const Cell& cell) {
  if (!cell.arm.serial || !cell.arm_serial || *cell.arm.serial == *cell.arm_serial) return;
  object.at("arm").fail("is the arm of the robot with the serial number " + in_quotes(*cell.arm.serial) +
                        ", and /arm_serial is " + in_quotes(*cell.arm_serial) +
                        "; give the arm of this robot, or that of its type");
}

/// Frames 0 (place) and 7 (tool) are the cell's to change; the joints are the arm's.
void read_frame_overrides(const JsonValue& value, Cell& cell) {
  int last_frame = -1;
  for (const JsonValue& item : value.items(1, 2)) {
    const int frame = frame_number(item);
    if (frame != 0 && frame != calib::kFrameCount - 1) {
      item.fail("overrides frame " + std::to_string(frame) +
                "; a cell has a say on frames 0 and 7 only, change the arm's file");
    }
    if (frame <= last_frame) item.fail("frames stand in order, each once; exchange or remove one");
    read_frame(item, frame, cell.arm);
    cell.own_frames.push_back(frame);
    last_frame = frame;
  }
}

void read_recipes(const JsonObject& object, std::optional<StiffnessChoice> stiffness, Cell& cell) {
  for (const JsonValue& item : object.at("recipes").items(1, kRecipeCountMax)) {
    Recipe recipe = read_recipe(named_file(item, cell), cell.arm, cell.block, cell.probe, stiffness);
    const std::string name = recipe.name;
    if (!cell.recipes.emplace(name, std::move(recipe)).second) {
      item.fail("a recipe with the name " + in_quotes(name) + " is already there; rename one of them");
    }
  }
  const JsonValue chosen = object.at("default_recipe");
  cell.default_recipe = chosen.text();
  if (!cell.recipes.contains(cell.default_recipe)) {
    chosen.fail("no recipe of this cell is called " + in_quotes(cell.default_recipe) +
                "; name one of /recipes");
  }
}

constexpr std::array kCellSchemas{kFirstCellSchema, kSecondCellSchema, kThirdCellSchema, kFourthCellSchema,
                                  kFifthCellSchema, kSixthCellSchema,  kCellSchema};

TouchingTip tip_from_json(const JsonValue& value, const Cell& cell) {
  constexpr NumberRange kRadii{.min = 0.0, .max = 50.0};          // mm
  constexpr NumberRange kRadiusStds{.min = 0.0, .max = 1.0};      // mm
  constexpr NumberRange kContactNoises{.min = 1e-4, .max = 1.0};  // mm
  const JsonObject object = value.object({"radius_mm", "std_radius_mm", "noise_mm"});
  return {.radius_m = object.metres("radius", kRadii),
          .std_radius_m = object.metres("std_radius", kRadiusStds),
          .noise_m = object.find_metres("noise", kContactNoises).value_or(cell.touch_noise_m)};
}

void read_tools(const JsonValue& tools, const SchemaVersion& version, Cell& cell) {
  for (const auto& [name, value] : tools.members()) {
    const JsonObject object = value.object({"position_mm", "rotation_deg", "tip_box_rms_max_mm", "tip"});
    cell.tools.emplace(name, pose_from_json(object));
    if (const auto tip = find_since(6, object, "tip", version)) {
      if (name == kStylusTool) tip->fail("is of the probe itself; give its figures in the probe's file");
      cell.tool_tips.emplace(name, tip_from_json(*tip, cell));
    }
    if (const auto limit = find_since(2, object, "tip_box_rms_max_mm", version))
      cell.acceptance.tool_box_rms_max_m[name] = calib::kMetresPerMillimetre * limit->number(kPositive);
  }
}

void read_space(const JsonObject& object, Cell& cell) {
  cell.workspace_box = box_from_json(object.at("workspace_box"));
  if (const auto boxes = object.find("keep_out_boxes")) cell.keep_out_boxes = boxes_from_json(*boxes);
  const JsonValue park = object.at("park_joints_deg");
  cell.park_joints = park.numbers<calib::kJointCount>().cwiseProduct(joint_units(cell.arm.model));
  if (!cell.arm.joint_ranges.contains(cell.park_joints))
    park.fail("a joint is outside its range; choose another posture");
}

void read_touch_conditions(const JsonObject& object, Cell& cell) {
  constexpr NumberRange kMisses{.min = kPositive.min, .max = 100.0};  // mm: beyond, no search would be safe
  constexpr NumberRange kTilts{.min = kPositive.min, .max = 89.0};    // degrees
  cell.nominal_position_error_m = object.metres("nominal_miss", kMisses);
  cell.stylus_tilt_max_rad = calib::radians_from_degrees(object.at("stylus_tilt_max_deg").number(kTilts));
  cell.touch_noise_m = object.metres("touch_noise", kNotNegative);
  cell.unknown_place_std = {.length_m = cell.nominal_position_error_m,
                            .angle_rad = cell.nominal_position_error_m / calib::kBlockPoseLeverMetres};
  if (const auto place = object.find("unknown_place_std")) {
    const JsonObject given = place->object({"length_mm", "angle_rad"});
    cell.unknown_place_std = {.length_m = given.metres("length", kPositive),
                              .angle_rad = given.at("angle_rad").number(kPositive)};
  }
}

/// How old a temperature of the block may be; came with the second schema.
void read_temperature_age(const JsonObject& object, const SchemaVersion& version, Cell& cell) {
  constexpr NumberRange kHours{.min = 0.1, .max = 8760.0};  // six minutes to a year
  const auto age = find_since(2, object, "block_temperature_age_max_h", version);
  if (!age) return;
  cell.block_temperature_age_max = std::chrono::round<std::chrono::minutes>(
      std::chrono::duration<double, std::chrono::hours::period>(age->number(kHours)));
}

void read_permit_lifetime(const JsonObject& object, const SchemaVersion& version, Cell& cell) {
  constexpr int kShiftMinutes = 480;
  if (const auto minutes = find_since(2, object, "permit_minutes", version))
    cell.permit_lifetime = std::chrono::minutes(minutes->integer(1, kShiftMinutes));
}

void read_check_interval(const JsonObject& object, const SchemaVersion& version, Cell& cell) {
  constexpr int kYearDays = 366;
  if (const auto days = find_since(4, object, "check_every_days", version))
    cell.check_every = std::chrono::days(days->integer(1, kYearDays));
}

/// Limits by the name of a recipe of this cell.
std::map<std::string, double> limits_by_recipe_m(const JsonValue& value, const Cell& cell) {
  std::map<std::string, double> limits_m;
  for (const auto& [name, limit] : value.members()) {
    if (!cell.recipes.contains(name))
      limit.fail("no recipe of this cell is called " + in_quotes(name) + "; name one of /recipes");
    limits_m[name] = calib::kMetresPerMillimetre * limit.number(kPositive);
  }
  return limits_m;
}

ProbeLimits probe_limits(const JsonValue& value) {
  const JsonObject object = value.object({"scatter_max_mm", "run_out_max_mm", "lobes_max_mm", "step_max_mm"});
  return {.scatter_max_m = object.find_metres("scatter_max", kPositive),
          .run_out_max_m = object.find_metres("run_out_max", kPositive),
          .lobes_max_m = object.find_metres("lobes_max", kPositive),
          .step_max_m = object.find_metres("step_max", kPositive)};
}

AcceptanceLimits acceptance_from_json(const JsonValue& value, const SchemaVersion& version,
                                      const Cell& cell) {
  const JsonObject object =
      value.object({"held_out_mean_max_mm", "held_out_rms_max_mm", "condition_number_max",
                    "lack_of_fit_p_min", "tip_box_rms_max_mm", "tip_box_max_mm", "tip_box_max_by_recipe_mm",
                    "reference_drift_max_mm", "proof_rms_max_mm", "probe", "decision"});
  constexpr NumberRange kConditionNumbers{.min = 1.0, .max = 1e16};
  constexpr NumberRange kProbabilities{.min = 0.0, .max = 0.5};
  AcceptanceLimits limits{
      .held_out_mean_max_m = object.metres("held_out_mean_max", kPositive),
      .held_out_rms_max_m = object.metres("held_out_rms_max", kPositive),
      .condition_number_max = object.at("condition_number_max").number(kConditionNumbers)};
  if (const auto least = object.find("lack_of_fit_p_min"))
    limits.lack_of_fit_p_min = least->number(kProbabilities);
  limits.tip_box_rms_max_m = object.find_metres("tip_box_rms_max", kPositive);
  if (const auto limit = find_since(2, object, "tip_box_max_mm", version))
    limits.tip_box_max_m = calib::kMetresPerMillimetre * limit->number(kPositive);
  if (const auto by_recipe = find_since(3, object, "tip_box_max_by_recipe_mm", version))
    limits.tip_box_max_by_recipe_m = limits_by_recipe_m(*by_recipe, cell);
  if (const auto decision = object.find("decision")) {
    const std::string rule = decision->text();
    if (rule != "simple" && rule != "guarded")
      decision->fail("is " + in_quotes(rule) + R"(; give "simple" or "guarded")");
    limits.guarded = rule == "guarded";
  }
  limits.reference_drift_max_m = object.find_metres("reference_drift_max", kPositive);
  if (const auto limit = find_since(4, object, "proof_rms_max_mm", version))
    limits.proof_rms_max_m = calib::kMetresPerMillimetre * limit->number(kPositive);
  if (const auto probe = find_since(5, object, "probe", version)) limits.probe = probe_limits(*probe);
  return limits;
}

constexpr NumberRange kTravelSpeeds{.min = kPositive.min, .max = 250.0};   // mm/s: what the controller takes
constexpr NumberRange kApproachSpeeds{.min = kPositive.min, .max = 20.0};  // mm/s: a hand can be taken away
constexpr NumberRange kSearchSpeeds{.min = kPositive.min,
                                    .max = 8.0};          // mm/s: what touch probes are made for
constexpr NumberRange kBackoffs{.min = 0.5, .max = 5.0};  // mm

/// A speed at which the probe may touch something: the arm stops within half of what the stylus may bend.
double touching_speed_m_s(const JsonValue& value, const NumberRange& range_mm_s, const Probe& probe) {
  const double speed_m_s = metres_from_mm(value.number(range_mm_s));
  if (calib::stop_distance_m(speed_m_s) > probe.overtravel_m / 2) {
    value.fail("the arm goes on for " +
               plain_number(calib::mm_from_metres(calib::stop_distance_m(speed_m_s))) +
               " mm after a contact at this speed, more than half the probe's overtravel_mm; go slower");
  }
  return speed_m_s;
}

std::optional<SecondTouch> second_touch_from_json(const JsonObject& object, const Probe& probe) {
  const auto speed = object.find("second_mm_s");
  if (!speed) {
    if (const auto backoff = object.find("second_backoff_mm"))
      backoff->fail("there is no second touch without \"second_mm_s\"; add it or remove this");
    return std::nullopt;
  }
  const NumberRange not_over_the_first{.min = kPositive.min,
                                       .max = object.at("search_mm_s").number(kSearchSpeeds)};
  return SecondTouch{.speed_m_s = touching_speed_m_s(*speed, not_over_the_first, probe),
                     .backoff_m = object.metres("second_backoff", kBackoffs)};
}

Speeds speeds_from_json(const JsonValue& value, const Probe& probe) {
  const JsonObject object =
      value.object({"travel_mm_s", "approach_mm_s", "search_mm_s", "second_mm_s", "second_backoff_mm"});
  const Speeds speeds{.travel_m_s = metres_from_mm(object.at("travel_mm_s").number(kTravelSpeeds)),
                      .approach_m_s = touching_speed_m_s(object.at("approach_mm_s"), kApproachSpeeds, probe),
                      .search_m_s = touching_speed_m_s(object.at("search_mm_s"), kSearchSpeeds, probe),
                      .second = second_touch_from_json(object, probe)};
  if (!probe.tip_is_contact_point && speeds.contact_m_s() != probe.calibration_speed_m_s) {
    object.at(speeds.second ? "second_mm_s" : "search_mm_s")
        .fail(
            "is not the probe's calibration_speed_mm_s, at which alone its pre-travel holds; "
            "touch at that speed or calibrate the probe at this one");
  }
  return speeds;
}

Deadlines deadlines_from_json(const JsonValue& value) {
  const JsonObject object =
      value.object({"connect_ms", "heartbeat_timeout_ms", "command_ms", "ready_ms", "confirm_ms"});
  constexpr int kHourMs = 3'600'000;
  constexpr int kConfirmMinMs = 1'000;  // what a controller takes
  constexpr int kConfirmMaxMs = 30'000;
  const auto deadline = [&object](std::string_view key) {
    return std::chrono::milliseconds(object.at(key).integer(1, kHourMs));
  };
  Deadlines deadlines{.connect = deadline("connect_ms"),
                      .heartbeat_timeout = deadline("heartbeat_timeout_ms"),
                      .command = deadline("command_ms")};
  if (object.has("ready_ms")) deadlines.ready = deadline("ready_ms");
  if (const auto confirm = object.find("confirm_ms"))
    deadlines.confirm = std::chrono::milliseconds(confirm->integer(kConfirmMinMs, kConfirmMaxMs));
  return deadlines;
}

Endpoint endpoint_from_json(const JsonValue& value) {
  const JsonObject object = value.object({"host", "port"});
  constexpr int kPortMax = 65'535;
  return {.host = object.at("host").text(),
          .port = static_cast<std::uint16_t>(object.at("port").integer(0, kPortMax))};
}

void demand_complete_change(const std::filesystem::path& file) {
  std::error_code unknown;
  const std::filesystem::path directory = file.parent_path().empty() ? "." : file.parent_path();
  if (std::filesystem::is_directory(directory / kBrokenChangeFolder, unknown))
    throw ConfigError(file.string(), "",
                      "a change of this cell by touchcal setup is not complete; touchcal setup " +
                          directory.string() + " --change completes it before its first question");
}

}  // namespace

Cell read_cell(const std::filesystem::path& file, std::optional<StiffnessChoice> stiffness) {
  const std::string source = file.string();
  demand_complete_change(file);
  const nlohmann::json document = read_json_file(file);
  const SchemaVersion version = schema_version(document, "cell", kCellSchemas);
  const JsonObject object = JsonValue(source, document)
                                .document(kCellSchemas[static_cast<std::size_t>(version.number) - 1],
                                          {"schema",
                                           "name",
                                           "arm",
                                           "arm_serial",
                                           "controller_serial",
                                           "frames",
                                           "block",
                                           "probe",
                                           "recipes",
                                           "default_recipe",
                                           "tools",
                                           "target_frames",
                                           "workspace_box",
                                           "keep_out_boxes",
                                           "park_joints_deg",
                                           "nominal_miss_mm",
                                           "stylus_tilt_max_deg",
                                           "touch_noise_mm",
                                           "unknown_place_std",
                                           "block_temperature_age_max_h",
                                           "permit_minutes",
                                           "check_every_days",
                                           "acceptance",
                                           "speeds",
                                           "deadlines",
                                           "controller"});
  Cell cell;
  cell.name = object.at("name").text();
  cell.file = file;
  cell.files = {file};
  cell.arm = read_arm(named_file(object.at("arm"), cell));
  if (const auto frames = object.find("frames")) read_frame_overrides(*frames, cell);
  cell.arm_serial = serial_number(find_since(4, object, "arm_serial", version));
  cell.controller_serial = serial_number(find_since(4, object, "controller_serial", version));
  demand_own_arm(object, cell);
  cell.block = read_block(named_file(object.at("block"), cell));
  cell.probe = read_probe(named_file(object.at("probe"), cell));
  read_recipes(object, stiffness, cell);
  read_space(object, cell);
  read_touch_conditions(object, cell);
  read_temperature_age(object, version, cell);
  read_permit_lifetime(object, version, cell);
  read_check_interval(object, version, cell);
  cell.acceptance = acceptance_from_json(object.at("acceptance"), version, cell);
  if (const auto tools = object.find("tools")) read_tools(*tools, version, cell);
  if (const auto frames = find_since(7, object, "target_frames", version))
    cell.target_frames = target_frames_from_json(*frames);
  cell.speeds = speeds_from_json(object.at("speeds"), cell.probe);
  cell.deadlines = deadlines_from_json(object.at("deadlines"));
  cell.controller = endpoint_from_json(object.at("controller"));
  return cell;
}

}  // namespace cell
