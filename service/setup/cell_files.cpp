#include "service/setup/cell_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calib_core/estimation/block_registration.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/motion_time.hpp"
#include "config/arm_writer.hpp"
#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/setup/block_text.hpp"
#include "service/setup/internal/answer_json.hpp"
#include "service/setup/park_posture.hpp"

namespace cell {
namespace {

namespace fs = std::filesystem;
constexpr const char* kPlacesFile = "places.json";
using calib::kMetresPerMillimetre;

constexpr std::pair<const char*, double> kSimulatedErrors[] = {
    {"theta0_rad", 0.00213},  {"r0_mm", -4.317},        {"alpha1_rad", -0.00174}, {"d1_mm", 4.842},
    {"theta1_rad", -0.00118}, {"r1_mm", -4.259},        {"alpha2_rad", -0.00119}, {"d2_mm", 0.213},
    {"theta2_rad", 0.00264},  {"r2_mm", -0.128},        {"beta2_rad", 0.00093},   {"alpha3_rad", 0.00082},
    {"d3_mm", -0.241},        {"theta3_rad", -0.00307}, {"r3_mm", 0.174},         {"beta3_rad", -0.00061},
    {"alpha4_rad", 0.00143},  {"d4_mm", -0.113},        {"theta4_rad", 0.00229},  {"r4_mm", 0.276},
    {"alpha5_rad", -0.00187}, {"d5_mm", 0.094},         {"theta5_rad", -0.00271}, {"r5_mm", -0.157},
    {"alpha6_rad", 0.00104},  {"d6_mm", -0.072},        {"theta6_rad", 0.00376},  {"r6_mm", 0.119},
    {"alpha7_rad", -0.00083}, {"d7_mm", 0.186},         {"theta7_rad", 0.00292},  {"r7_mm", -0.258}};

Eigen::Isometry3d pose_of(const BasePlace& base) {
  const Eigen::Vector3d turn = calib::kRadiansPerDegree * base.rotation_deg;
  return Eigen::Translation3d(kMetresPerMillimetre * base.position_mm) *
         Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ());
}

/// On the floor beside the block, at a distance at which it reaches behind it.
BasePlace assumed_base(const SetupArm& source) {
  constexpr double kShareOfReach = 0.6;
  const double away_mm = kShareOfReach * reach_of(source.arm.model) / kMetresPerMillimetre;
  return {.position_mm = {-std::round(away_mm), 0.0, 0.0}, .rotation_deg = {90.0, 0.0, 0.0}};
}

/// The arm where it stands, with this probe on it. The block's bottom is level, so that its y points down.
Arm placed_arm(const SetupAnswers& answers, const SetupArm& source) {
  Arm arm = source.arm;
  if (answers.base || source.is_made) {
    calib::set_block_pose(arm.model,
                          pose_of(answers.base.value_or(assumed_base(source))) * source.base_from_frame1);
    const Eigen::Vector3d down = calib::block_pose_of(arm.model).linear().row(1).transpose();
    arm.model.down_in_frame_1 = down.normalized();
  }
  const ProbeAnswers& probe = answers.probe;
  double& ball_m = arm.model.links.back().r_m;
  if (source.is_made) {
    const double parts_mm = probe.stem_length_mm + probe.body_length_mm + probe.holder_length_mm;
    ball_m += kMetresPerMillimetre * probe.length_mm.value_or(parts_mm);
  } else if (probe.length_mm) {
    ball_m = kMetresPerMillimetre * *probe.length_mm;
  }
  return arm;
}

Eigen::Vector3d base_position_mm(const Arm& arm) {
  return calib::block_pose_of(arm.model).translation() / kMetresPerMillimetre;
}

calib::Capsule probe_part(const char* name, double from_mm, double to_mm, double radius_mm) {
  return {name, calib::kFrameCount - 1, kMetresPerMillimetre * Eigen::Vector3d(0.0, 0.0, from_mm),
          kMetresPerMillimetre * Eigen::Vector3d(0.0, 0.0, to_mm), kMetresPerMillimetre * radius_mm};
}

/// From the flange to the ball, along the stylus.
std::vector<calib::Capsule> probe_parts(const ProbeAnswers& probe) {
  const double body_mm = probe.stem_length_mm, holder_mm = body_mm + probe.body_length_mm;
  std::vector<calib::Capsule> parts;
  if (probe.holder_length_mm > 0.0)
    parts.push_back(
        probe_part("tool holder", -holder_mm - probe.holder_length_mm, -holder_mm, probe.holder_radius_mm));
  parts.push_back(probe_part("probe body", -holder_mm, -body_mm, probe.body_radius_mm));
  parts.push_back(probe_part("stem", -body_mm, -probe.ball_radius_mm - 1.0, probe.stem_radius_mm));
  parts.push_back(probe_part("ball", 0.0, 0.0, probe.ball_radius_mm));
  return parts;
}

/// Written as it was answered; a metre and back would add digits.
double rounded_mm(double metres) { return std::round(metres * 1e9) / 1e6; }

Json rounded_triple(const Eigen::Vector3d& point_m) {
  return {rounded_mm(point_m.x()), rounded_mm(point_m.y()), rounded_mm(point_m.z())};
}

std::string probe_text(const ProbeAnswers& probe) {
  Json bodies = Json::array();
  for (const calib::Capsule& part : probe_parts(probe))
    bodies.push_back({{"name", part.name},
                      {"frame", part.frame},
                      {"from_mm", rounded_triple(part.from_m)},
                      {"to_mm", rounded_triple(part.to_m)},
                      {"radius_mm", rounded_mm(part.radius_m)}});
  Json document{{"schema", "touchcal/probe/4"}, {"name", probe.name}};
  if (probe.serial) document["serial"] = *probe.serial;
  document["stylus_radius_mm"] = probe.ball_radius_mm;
  document["std_stylus_radius_mm"] = probe.std_ball_radius_mm;
  document["pretravel_mm"] = probe.pretravel_mm;
  document["std_pretravel_mm"] = probe.std_pretravel_mm;
  document["overtravel_mm"] = probe.overtravel_mm;
  document["calibration_speed_mm_s"] = probe.speed_mm_s;
  document["bodies"] = bodies;
  return document.dump(2) + "\n";
}

/// The fastest of these at which the arm stops within half of what the stylus may bend.
double touching_speed(const ProbeAnswers& probe, std::initializer_list<double> speeds_mm_s) {
  for (const double speed : speeds_mm_s) {
    const double stop_mm = calib::stop_distance_m(kMetresPerMillimetre * speed) / kMetresPerMillimetre;
    if (stop_mm <= 0.5 * probe.overtravel_mm) return speed;
  }
  return probe.speed_mm_s;
}

Json speeds_json(const ProbeAnswers& probe) {
  Json speeds{{"travel_mm_s", 250},
              {"approach_mm_s", touching_speed(probe, {20.0, 10.0, 5.0, 2.0})},
              {"search_mm_s", std::max(touching_speed(probe, {8.0, 5.0, 2.0}), probe.speed_mm_s)}};
  speeds["second_mm_s"] = probe.speed_mm_s;
  speeds["second_backoff_mm"] = 2;
  return speeds;
}

Json acceptance_json(const SetupAnswers& answers) {
  const LimitAnswers& limits = answers.limits;
  Json acceptance{{"held_out_mean_max_mm", limits.held_out_mean_max_mm},
                  {"held_out_rms_max_mm", limits.held_out_rms_max_mm},
                  {"condition_number_max", limits.condition_number_max},
                  {"tip_box_max_mm", limits.tip_box_max_mm}};
  for (const auto& [recipe, limit] : limits.tip_box_max_by_recipe_mm)
    acceptance["tip_box_max_by_recipe_mm"][recipe] = limit;
  acceptance["probe"] = {{"run_out_max_mm", 1}, {"lobes_max_mm", 0.02}, {"step_max_mm", 0.15}};
  return acceptance;
}

Json box_answer_json(const BoxAnswers& box) {
  return {{"name", box.name}, {"min_mm", triple_json(box.min_mm)}, {"max_mm", triple_json(box.max_mm)}};
}

calib::Box box_of(const BoxAnswers& box) {
  return {box.name, kMetresPerMillimetre * box.min_mm, kMetresPerMillimetre * box.max_mm};
}

Json park_json(const Cell& scene) {
  Json joints = Json::array();
  for (const double joint : scene.park_joints)
    joints.push_back(std::round(joint / calib::kRadiansPerDegree * 1e6) / 1e6);
  return joints;
}

void add_surroundings(const SetupAnswers& answers, const Cell& scene, Json& document) {
  Json boxes = Json::array();
  for (const BoxAnswers& box : answers.keep_out_boxes) boxes.push_back(box_answer_json(box));
  document["workspace_box"] = box_answer_json(answers.workspace_box);
  document["keep_out_boxes"] = boxes;
  document["park_joints_deg"] = park_json(scene);
  document["nominal_miss_mm"] = answers.nominal_miss_mm;
  document["stylus_tilt_max_deg"] = answers.stylus_tilt_max_deg;
  document["touch_noise_mm"] = answers.touch_noise_mm;
}

Json tool_json(const ToolAnswers& tool) {
  Json json{{"position_mm", triple_json(tool.position_mm)}, {"rotation_deg", triple_json(tool.rotation_deg)}};
  if (tool.tip)
    json["tip"] = {{"radius_mm", tool.tip->radius_mm}, {"std_radius_mm", tool.tip->std_radius_mm}};
  return json;
}

/// The shipped recipe `best` at all places of the block.
std::string places_recipe(const CuboidAnswers& block, const std::string& best) {
  Json recipe = Json::parse(best), names = Json::array();
  for (const PlaceAnswers& place : block.places) names.push_back(place.name);
  recipe["schema"] = "touchcal/recipe/5";
  recipe["name"] = kSetupPlacesRecipe;
  recipe["description"] =
      "100 touches of the block where it stands and at its further places, chosen for the tip error in the "
      "workspace box; 10 held out on each plane";
  recipe["places"] = names;
  return recipe.dump(2) + "\n";
}

std::string cell_text(const SetupAnswers& answers, const Cell& scene) {
  Json document{{"schema", kCellSchema}, {"name", answers.name}, {"arm", "arm.json"}};
  if (answers.arm_serial) document["arm_serial"] = *answers.arm_serial;
  if (answers.controller_serial) document["controller_serial"] = *answers.controller_serial;
  document["block"] = "block.json";
  document["probe"] = "probe.json";
  document["recipes"] = Json::array();
  for (const std::string_view recipe : kSetupRecipes)
    document["recipes"].push_back(std::string(recipe) + ".json");
  if (!answers.block.places.empty()) document["recipes"].push_back(kPlacesFile);
  document["default_recipe"] = answers.default_recipe;
  for (const ToolAnswers& tool : answers.tools) document["tools"][tool.name] = tool_json(tool);
  add_surroundings(answers, scene, document);
  document["acceptance"] = acceptance_json(answers);
  document["speeds"] = speeds_json(answers.probe);
  document["deadlines"] = {{"connect_ms", 2000}, {"heartbeat_timeout_ms", 500}, {"command_ms", 120'000}};
  document["controller"] = {{"host", answers.controller.host}, {"port", answers.controller.port}};
  return document.dump(2) + "\n";
}

/// What the simulated arm is really like: errors of the size that a new arm has, so that it misses by less
/// than the answers say. Those of the shipped demo, smaller for a long arm or one that was located.
std::string simulated_truth(const SetupAnswers& answers, const Cell& scene) {
  constexpr double kMissOfThemMm = 12.0, kReachMetres = 1.2;
  const double share = std::min(1.0, answers.nominal_miss_mm / kMissOfThemMm) *
                       std::min(1.0, kReachMetres / reach_of(scene.arm.model));
  Json errors = Json::object();
  for (const auto& [name, value] : kSimulatedErrors) errors[name] = std::round(share * value * 1e6) / 1e6;
  return Json{
             {"schema", "touchcal/truth/1"}, {"name", "simulated arm of " + answers.name}, {"errors", errors}}
             .dump(2) +
         "\n";
}

/// A folder that goes with its owner.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const fs::path& inside) {
    std::string name = (inside / "touchcal-setup-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw std::runtime_error(inside.string() + " cannot be written; set TMPDIR to a folder that can");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

Cell setup_scene(const SetupAnswers& answers, const SetupArm& source) {
  Cell scene;
  scene.name = answers.name;
  scene.arm = placed_arm(answers, source);
  scene.probe.bodies = probe_parts(answers.probe);
  scene.block.solids = setup_solids(answers.block);
  for (const SetupFace& face : setup_faces(answers.block, base_position_mm(scene.arm)))
    scene.block.faces.push_back({.plane = {face.outward, kMetresPerMillimetre * face.offset_mm},
                                 .center_m = kMetresPerMillimetre * face.center_mm,
                                 .edge_u = face.edge_u,
                                 .half_extent_m = kMetresPerMillimetre * face.half_extent_mm});
  scene.workspace_box = box_of(answers.workspace_box);
  for (const BoxAnswers& box : answers.keep_out_boxes) scene.keep_out_boxes.push_back(box_of(box));
  scene.nominal_position_error_m = kMetresPerMillimetre * answers.nominal_miss_mm;
  if (answers.park_joints_deg) {
    for (int joint = 0; joint < calib::kJointCount; ++joint)
      scene.park_joints[joint] =
          calib::kRadiansPerDegree * answers.park_joints_deg->at(static_cast<std::size_t>(joint));
  } else {
    scene.park_joints = find_park_posture(scene);
  }
  return scene;
}

CellFiles cell_files(const SetupAnswers& answers, const SetupArm& source,
                     const std::map<std::string, std::string>& recipes) {
  const Cell scene = setup_scene(answers, source);
  CellFiles files{{"arm.json", arm_document(scene.arm)},
                  {"block.json", block_text(answers.block, base_position_mm(scene.arm))},
                  {"probe.json", probe_text(answers.probe)},
                  {"truth.json", simulated_truth(answers, scene)},
                  {kSetupCellFile, cell_text(answers, scene)},
                  {kSetupAnswersFile, setup_document(answers)}};
  for (const std::string_view recipe : kSetupRecipes)
    files[std::string(recipe) + ".json"] = recipes.at(std::string(recipe));
  if (!answers.block.places.empty()) files[kPlacesFile] = places_recipe(answers.block, recipes.at("best"));
  return files;
}

std::vector<std::string> scene_remarks(const Cell& scene) {
  std::vector<std::string> remarks;
  if (const auto clash = park_clash(scene))
    remarks.push_back(
        fmt::format("the park posture has {} {:.0f} mm from {}; no cell is written while it is so",
                    clash->body, clash->distance_m / kMetresPerMillimetre, clash->other));
  const double reach_m = reach_of(scene.arm.model);
  const Eigen::Vector3d shoulder_m = calib::block_pose_of(scene.arm.model).translation();
  for (std::size_t i = 0; i < scene.block.faces.size(); ++i) {
    const double distance_m = (scene.block.faces[i].center_m - shoulder_m).norm();
    if (distance_m > reach_m)
      remarks.push_back(fmt::format(
          "{} is {:.0f} mm from the base and the arm reaches {:.0f} mm; bring the block nearer or correct "
          "the base",
          calib::face_name(i), distance_m / kMetresPerMillimetre, reach_m / kMetresPerMillimetre));
  }
  return remarks;
}

void demand_clear_park(const SetupAnswers& answers, const Cell& scene) {
  const auto clash = park_clash(scene);
  if (!clash) return;
  const double miss_mm = scene.nominal_position_error_m / kMetresPerMillimetre;
  if (answers.park_joints_deg)
    throw ConfigError(
        "answers", "/park_joints_deg",
        fmt::format("{} is {:.0f} mm from {} in the park posture and must be {:.0f} mm away (10 of "
                    "another body of the arm); give another posture, or - to have one searched",
                    clash->body, clash->distance_m / kMetresPerMillimetre, clash->other, miss_mm));
  const auto obstruction = park_obstruction(scene);
  throw ConfigError(
      "answers", "/park_joints_deg",
      fmt::format(
          "no posture was found in which the arm is clear; {} is too near {}{}; correct the bodies of "
          "arm and probe (guessed radii: body_radii_mm of the arm, holder_radius_mm), the boxes or the "
          "base, or give a posture",
          obstruction ? obstruction->body : clash->body, obstruction ? obstruction->other : clash->other,
          obstruction ? fmt::format(" in {:.0f} % of those that were tried", 100.0 * obstruction->share)
                      : std::string()));
}

Cell check_cell_files(const CellFiles& files, const fs::path& temporary) {
  const TemporaryFolder folder(temporary);
  for (const auto& [name, text] : files) {
    std::ofstream stream(folder.path() / name, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream)
      throw std::runtime_error((folder.path() / name).string() + " cannot be written; is the disk full?");
  }
  try {
    Cell cell = read_cell(folder.path() / kSetupCellFile);
    demand_revolute(cell);
    return cell;
  } catch (const ConfigError& error) {
    throw ConfigError(fs::path(error.source()).filename().string(), error.pointer(), error.message());
  }
}

}  // namespace cell
