#include "service/setup/answers.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"
#include "config/serial_number.hpp"
#include "config/strict_json.hpp"

namespace cell {
namespace {

constexpr NumberRange kBlockSizesMm{.min = 10.0, .max = 2000.0};
constexpr NumberRange kCertificateStdsMm{.min = 1e-5, .max = 1.0};
constexpr NumberRange kBallsMm{.min = 0.1, .max = 25.0};
constexpr NumberRange kStemsMm{.min = 0.1, .max = 25.0};
constexpr NumberRange kProbePartsMm{.min = 0.1, .max = 1000.0};
constexpr std::size_t kBoxCountMax = 50;
constexpr std::size_t kToolCountMax = 50;
constexpr std::size_t kPlaceCountMax = 8;
constexpr std::size_t kTextCountMax = 20;

Eigen::Vector3d triple(const JsonValue& value) { return value.numbers<3>(); }

void take(const JsonObject& object, std::string_view key, const NumberRange& range, double& into) {
  if (const auto value = object.find(key)) into = value->number(range);
}

void take(const JsonObject& object, std::string_view key, std::string& into) {
  if (const auto value = object.find(key)) into = value->text();
}

void take(const JsonObject& object, std::string_view key, Eigen::Vector3d& into) {
  if (const auto value = object.find(key)) into = triple(*value);
}

/// null says that it is not known, or that it is to be found.
template <class T, class Read>
void take_optional(const JsonObject& object, std::string_view key, std::optional<T>& into, Read read) {
  const auto value = object.find(key);
  if (!value) return;
  if (value->is_null()) {
    into = std::nullopt;
  } else {
    into = read(*value);
  }
}

void take_serial(const JsonObject& object, std::string_view key, std::optional<std::string>& into) {
  take_optional(object, key, into, [](const JsonValue& value) { return *serial_number(value); });
}

ArmChoice read_arm_choice(const JsonValue& value) {
  const JsonObject object =
      value.object({"file", "urdf", "base_link", "tip_link", "dh", "dh_convention", "body_radii_mm"});
  ArmChoice arm;
  const int ways = int(object.has("file")) + int(object.has("urdf")) + int(object.has("dh"));
  if (ways != 1)
    value.fail(
        R"(give one of "file" (a shipped arm's name or a path), "urdf" with "base_link" and "tip_link", )"
        R"(and "dh")");
  arm.file.clear();
  take(object, "file", arm.file);
  take(object, "urdf", arm.urdf);
  take(object, "dh", arm.dh);
  if (const auto convention = object.find("dh_convention")) {
    arm.dh_convention = convention->text();
    if (arm.dh.empty() || (arm.dh_convention != "standard" && arm.dh_convention != "modified"))
      convention->fail(R"(is "standard" or "modified", beside "dh"; correct or remove it)");
  }
  if (arm.urdf.empty() && (object.has("base_link") || object.has("tip_link")))
    value.fail(R"("base_link" and "tip_link" belong to a "urdf"; remove them)");
  take_optional(object, "body_radii_mm", arm.body_radii_mm, [](const JsonValue& given) {
    std::vector<double> radii_mm;
    for (const JsonValue& radius : given.items(6, 6))
      radii_mm.push_back(radius.number({.min = 1.0, .max = 1000.0}));
    return radii_mm;
  });
  if (arm.body_radii_mm && !arm.file.empty())
    object.at("body_radii_mm")
        .fail("belongs to an arm of a URDF or a table; one of a file has its bodies there");
  if (!arm.urdf.empty()) {
    arm.base_link = object.at("base_link").text();
    arm.tip_link = object.at("tip_link").text();
  }
  return arm;
}

BasePlace read_base(const JsonValue& value) {
  const JsonObject object = value.object({"position_mm", "rotation_deg"});
  return {.position_mm = triple(object.at("position_mm")), .rotation_deg = triple(object.at("rotation_deg"))};
}

std::vector<TouchedSide> read_sides(const JsonValue& value) {
  std::vector<TouchedSide> sides;
  for (const JsonValue& item : value.items(1, std::size(kSideNames))) {
    const JsonObject object = item.object({"side", "name"});
    const JsonValue side = object.at("side");
    if (std::ranges::find(kSideNames, side.text()) == std::end(kSideNames))
      side.fail(
          "is " + in_quotes(side.text()) +
          "; give -x, +x, -z, +z or -y (the top), the direction that the side faces in the block's frame");
    if (std::ranges::find(sides, side.text(), &TouchedSide::side) != sides.end())
      side.fail("is there twice; name each side once");
    sides.push_back({side.text(), object.has("name") ? object.at("name").text() : side.text()});
  }
  // In the order of their names, by which the planes are numbered.
  std::ranges::sort(sides, {}, [](const TouchedSide& side) {
    return std::ranges::find(kSideNames, side.side) - std::begin(kSideNames);
  });
  return sides;
}

/// The directions of what is touched: without three of them the block's place is not determined.
void demand_three_directions(const JsonValue& value, const CuboidAnswers& block) {
  std::string directions;
  if (block.ground_plate) directions += 'y';
  for (const TouchedSide& side : block.sides)
    if (directions.find(side.side[1]) == std::string::npos) directions += side.side[1];
  if (directions.size() < 3)
    value.fail(
        "leave the place of the block open; touch sides in three directions: one of -x and +x, one of -z and "
        "+z, "
        "and -y (or the ground plate)");
  if (block.sides.size() + (block.ground_plate ? 1U : 0U) < 4)
    value.fail("are too few for 25 parameters; touch four faces at least, the ground plate counts");
}

/// Of an answer, or of what it is part of where it was not given.
[[noreturn]] void fail_at(const JsonObject& object, std::string_view key, const std::string& message) {
  if (const auto given = object.find(key)) given->fail(message);
  object.fail(message);
}

void read_block_size(const JsonObject& object, CuboidAnswers& block) {
  if (const auto size = object.find("size_mm")) {
    const auto edges = size->items(3, 3);
    for (std::size_t i = 0; i < edges.size(); ++i)
      block.size_mm[static_cast<Eigen::Index>(i)] = edges[i].number(kBlockSizesMm);
  }
  take(object, "std_mm", kCertificateStdsMm, block.std_mm);
  if (const auto plate = object.find("plate_mm")) {
    const auto edges = plate->items(3, 3);
    for (std::size_t i = 0; i < edges.size(); ++i)
      block.plate_mm[static_cast<Eigen::Index>(i)] = edges[i].number({.min = 1.0, .max = 10'000.0});
  } else {
    for (const Eigen::Index along : {0, 2})
      block.plate_mm[along] = fitting_plate_mm(block.plate_mm[along], block.size_mm[along]);
  }
}

/// A plate that is touched has room for it beside the block.
void demand_plate_room(const JsonObject& object, const CuboidAnswers& block) {
  if (!block.ground_plate) return;
  const bool is_wide = block.plate_mm.x() >= block.size_mm.x() + kPlateRoomMinMm &&
                       block.plate_mm.z() >= block.size_mm.z() + kPlateRoomMinMm;
  if (!is_wide)
    fail_at(object, "plate_mm",
            "the ground plate has no room to be touched beside the block; give \"plate_mm\" of at least the "
            "block's "
            "size and 110 mm along x and z, or \"ground_plate\": false");
}

std::vector<PlaceAnswers> read_place_answers(const JsonValue& value) {
  std::vector<PlaceAnswers> places;
  for (const JsonValue& item : value.items(0, kPlaceCountMax)) {
    const JsonObject object = item.object({"name", "position_mm", "rotation_deg", "within_mm"});
    PlaceAnswers place{.name = object.at("name").text(), .position_mm = triple(object.at("position_mm"))};
    take(object, "rotation_deg", place.rotation_deg);
    take(object, "within_mm", {.min = 0.1, .max = 50.0}, place.within_mm);
    if (std::ranges::find(places, place.name, &PlaceAnswers::name) != places.end())
      object.at("name").fail("is there twice; name each place differently");
    places.push_back(std::move(place));
  }
  return places;
}

CuboidAnswers read_cuboid(const JsonValue& value) {
  const JsonObject object = value.object({"name", "serial", "size_mm", "std_mm", "sides", "ground_plate",
                                          "plate_mm", "temperature_c", "std_temperature_k",
                                          "thermal_expansion_per_k", "certificate", "places"});
  CuboidAnswers block;
  take(object, "name", block.name);
  take_serial(object, "serial", block.serial);
  read_block_size(object, block);
  if (const auto plate = object.find("ground_plate")) block.ground_plate = plate->boolean();
  demand_plate_room(object, block);
  if (const auto sides = object.find("sides")) block.sides = read_sides(*sides);
  demand_three_directions(object.has("sides") ? object.at("sides") : value, block);
  take_optional(object, "temperature_c", block.temperature_c,
                [](const JsonValue& given) { return given.number({.min = -20.0, .max = 60.0}); });
  take(object, "std_temperature_k", {.min = 0.0, .max = 10.0}, block.std_temperature_k);
  take(object, "thermal_expansion_per_k", {.min = 0.0, .max = 1e-3}, block.expansion_per_k);
  if (const auto certificate = object.find("certificate")) {
    const auto texts = certificate->members();
    if (texts.size() > kTextCountMax)
      certificate->fail("has too many texts; keep those that the report shows");
    for (const auto& [key, text] : texts) block.certificate.emplace(key, text.text());
  }
  if (const auto places = object.find("places")) block.places = read_place_answers(*places);
  return block;
}

ProbeAnswers read_probe_answers(const JsonValue& value) {
  const JsonObject object = value.object({"name", "serial", "ball_radius_mm", "std_ball_radius_mm",
                                          "pretravel_mm", "std_pretravel_mm", "overtravel_mm", "speed_mm_s",
                                          "length_mm", "stem_length_mm", "stem_radius_mm", "body_length_mm",
                                          "body_radius_mm", "holder_length_mm", "holder_radius_mm"});
  ProbeAnswers probe;
  take(object, "name", probe.name);
  take_serial(object, "serial", probe.serial);
  take(object, "ball_radius_mm", kBallsMm, probe.ball_radius_mm);
  take(object, "std_ball_radius_mm", {.min = 0.0, .max = 1.0}, probe.std_ball_radius_mm);
  take(object, "pretravel_mm", {.min = 0.0, .max = 5.0}, probe.pretravel_mm);
  take(object, "std_pretravel_mm", {.min = 0.0, .max = 1.0}, probe.std_pretravel_mm);
  take(object, "overtravel_mm", {.min = 0.1, .max = 50.0}, probe.overtravel_mm);
  take(object, "speed_mm_s", {.min = 0.1, .max = 8.0}, probe.speed_mm_s);
  take_optional(object, "length_mm", probe.length_mm,
                [](const JsonValue& given) { return given.number({.min = 10.0, .max = 2000.0}); });
  take(object, "stem_length_mm", kProbePartsMm, probe.stem_length_mm);
  take(object, "stem_radius_mm", kStemsMm, probe.stem_radius_mm);
  take(object, "body_length_mm", kProbePartsMm, probe.body_length_mm);
  take(object, "body_radius_mm", {.min = 1.0, .max = 200.0}, probe.body_radius_mm);
  take(object, "holder_length_mm", {.min = 0.0, .max = 1000.0}, probe.holder_length_mm);
  take(object, "holder_radius_mm", {.min = 1.0, .max = 300.0}, probe.holder_radius_mm);
  if (!object.has("stem_length_mm"))
    probe.stem_length_mm = std::max(probe.stem_length_mm, 2.0 * probe.ball_radius_mm + 2.0);
  const double thinner_mm = kStemShare * probe.ball_radius_mm;
  const bool is_too_thick = probe.stem_radius_mm >= probe.ball_radius_mm;
  if (!object.has("stem_radius_mm") && is_too_thick && thinner_mm >= kStemsMm.min)
    probe.stem_radius_mm = thinner_mm;
  if (probe.stem_length_mm <= probe.ball_radius_mm + 1.0)
    fail_at(
        object, "stem_length_mm",
        "the stem is not longer than the ball; \"stem_length_mm\" is from the ball's centre to the probe's "
        "body");
  if (probe.stem_radius_mm >= probe.ball_radius_mm)
    fail_at(object, "stem_radius_mm",
            "the stem is as thick as the ball, so that it would touch first; correct \"stem_radius_mm\" or "
            "\"ball_radius_mm\"");
  return probe;
}

BoxAnswers read_box(const JsonValue& value) {
  const JsonObject object = value.object({"name", "min_mm", "max_mm"});
  BoxAnswers box{object.at("name").text(), triple(object.at("min_mm")), triple(object.at("max_mm"))};
  if (!(box.min_mm.array() < box.max_mm.array()).all())
    object.at("max_mm").fail(
        "is not above \"min_mm\" in each of x, y and z (y is down); exchange or correct them");
  return box;
}

ToolTipAnswers read_tool_tip(const JsonValue& value) {
  const JsonObject object = value.object({"radius_mm", "std_radius_mm"});
  ToolTipAnswers tip{.radius_mm = object.at("radius_mm").number({.min = 0.0, .max = 100.0})};
  take(object, "std_radius_mm", {.min = 0.0, .max = 1.0}, tip.std_radius_mm);
  return tip;
}

std::vector<ToolAnswers> read_tool_answers(const JsonValue& value) {
  std::vector<ToolAnswers> tools;
  for (const JsonValue& item : value.items(0, kToolCountMax)) {
    const JsonObject object = item.object({"name", "position_mm", "rotation_deg", "tip"});
    ToolAnswers tool{.name = object.at("name").text(), .position_mm = triple(object.at("position_mm"))};
    take(object, "rotation_deg", tool.rotation_deg);
    take_optional(object, "tip", tool.tip, read_tool_tip);
    if (tool.name == "stylus") object.at("name").fail("is the probe's own; give the tool another name");
    if (std::ranges::find(tools, tool.name, &ToolAnswers::name) != tools.end())
      object.at("name").fail("is there twice; name each tool differently");
    tools.push_back(std::move(tool));
  }
  return tools;
}

LimitAnswers read_limits(const JsonValue& value) {
  const JsonObject object =
      value.object({"held_out_mean_max_mm", "held_out_rms_max_mm", "condition_number_max", "tip_box_max_mm",
                    "tip_box_max_by_recipe_mm", "from_plans"});
  LimitAnswers limits;
  take(object, "held_out_mean_max_mm", kPositive, limits.held_out_mean_max_mm);
  take(object, "held_out_rms_max_mm", kPositive, limits.held_out_rms_max_mm);
  take(object, "condition_number_max", {.min = 1.0, .max = 1e16}, limits.condition_number_max);
  take(object, "tip_box_max_mm", kPositive, limits.tip_box_max_mm);
  if (const auto by_recipe = object.find("tip_box_max_by_recipe_mm")) {
    for (const auto& [recipe, limit] : by_recipe->members()) {
      if (std::ranges::find(kSetupRecipes, recipe) == std::end(kSetupRecipes) && recipe != kSetupPlacesRecipe)
        limit.fail(
            "there is no recipe of this name; the cell has quick, best and, with further places, places");
      limits.tip_box_max_by_recipe_mm[recipe] = limit.number(kPositive);
    }
  }
  limits.from_plans = limits.tip_box_max_by_recipe_mm.empty();
  if (const auto from_plans = object.find("from_plans")) limits.from_plans = from_plans->boolean();
  return limits;
}

Endpoint read_controller(const JsonValue& value) {
  const JsonObject object = value.object({"host", "port"});
  return {.host = object.at("host").text(),
          .port = static_cast<std::uint16_t>(object.at("port").integer(1, 65'535))};
}

std::vector<double> read_park(const JsonValue& value) {
  const Eigen::Matrix<double, 6, 1> joints = value.numbers<6>();
  return {joints.begin(), joints.end()};
}

void read_surroundings(const JsonObject& object, SetupAnswers& answers) {
  if (const auto box = object.find("workspace_box")) answers.workspace_box = read_box(*box);
  if (const auto boxes = object.find("keep_out_boxes")) {
    answers.keep_out_boxes.clear();
    for (const JsonValue& item : boxes->items(0, kBoxCountMax))
      answers.keep_out_boxes.push_back(read_box(item));
  }
  take(object, "nominal_miss_mm", {.min = 0.1, .max = 100.0}, answers.nominal_miss_mm);
  take(object, "stylus_tilt_max_deg", {.min = 1.0, .max = 89.0}, answers.stylus_tilt_max_deg);
  take(object, "touch_noise_mm", {.min = 1e-4, .max = 1.0}, answers.touch_noise_mm);
  take_optional(object, "park_joints_deg", answers.park_joints_deg, read_park);
}

}  // namespace

SetupAnswers read_setup_answers(const std::string& source, std::string_view text) {
  const nlohmann::json document = parse_strict_json(source, text, kConfigFileSizeMax);
  const JsonValue root(source, document);
  const JsonObject object = root.document(
      kSetupSchema, {"schema", "name", "arm", "arm_serial", "controller_serial", "base", "block", "probe",
                     "workspace_box", "keep_out_boxes", "nominal_miss_mm", "stylus_tilt_max_deg",
                     "touch_noise_mm", "park_joints_deg", "limits", "tools", "default_recipe", "controller"});
  SetupAnswers answers;
  take(object, "name", answers.name);
  if (const auto arm = object.find("arm")) answers.arm = read_arm_choice(*arm);
  take_serial(object, "arm_serial", answers.arm_serial);
  take_serial(object, "controller_serial", answers.controller_serial);
  take_optional(object, "base", answers.base, read_base);
  if (const auto block = object.find("block")) answers.block = read_cuboid(*block);
  if (const auto probe = object.find("probe")) answers.probe = read_probe_answers(*probe);
  read_surroundings(object, answers);
  if (const auto limits = object.find("limits")) answers.limits = read_limits(*limits);
  if (const auto tools = object.find("tools")) answers.tools = read_tool_answers(*tools);
  if (const auto recipe = object.find("default_recipe")) {
    answers.default_recipe = recipe->text();
    if (std::ranges::find(kSetupRecipes, answers.default_recipe) == std::end(kSetupRecipes))
      recipe->fail("is " + in_quotes(answers.default_recipe) + "; give quick or best");
  }
  if (const auto controller = object.find("controller")) answers.controller = read_controller(*controller);
  return answers;
}

}  // namespace cell
