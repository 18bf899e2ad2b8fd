#include "service/setup/setup_check.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "service/setup/arm_source.hpp"
#include "service/setup/scene_drawing.hpp"

namespace cell {
namespace {

constexpr const char* kArmElsewhere =
    "an arm of a file, a URDF or a table is read at the cell: touchcal setup draws the scene and checks the "
    "cell there; here that is done for shipped arms";

bool is_elsewhere(const ArmChoice& arm) {
  const std::filesystem::path file = arm.file;
  return !arm.urdf.empty() || !arm.dh.empty() || file.has_parent_path() || file.has_extension();
}

std::optional<SetupArm> shipped_arm(const ArmChoice& choice, const SetupPlaces& places, SetupCheck& check) {
  const std::vector<std::string> names = shipped_arms(places.shipped_config);
  if (std::ranges::find(names, choice.file) != names.end())
    return read_setup_arm({.file = choice.file}, places.shipped_config);
  std::string listed;
  for (const std::string& name : names) listed += (listed.empty() ? "" : ", ") + name;
  check.refused.push_back({.pointer = "/arm/file",
                           .sentence = "there is no shipped arm " + in_quotes(choice.file),
                           .remedy = "shipped are " + listed});
  return std::nullopt;
}

/// What the answers are refused for together.
void note(SetupCheck& check, const ConfigError& error, const CellFiles& files) {
  RefusedAnswer refused = refused_answer(error.pointer(), error.message());
  if (files.contains(error.source())) refused.file = error.source();
  check.refused.push_back(std::move(refused));
}

/// With the park posture that was found: it is searched once.
SetupAnswers parked(SetupAnswers answers, const Cell& scene) {
  if (answers.park_joints_deg) return answers;
  constexpr double kPerDegree = 1e9;  // whole degrees come back as such
  std::vector<double> joints_deg;
  for (const double joint_rad : scene.park_joints)
    joints_deg.push_back(std::round(joint_rad / calib::kRadiansPerDegree * kPerDegree) / kPerDegree);
  answers.park_joints_deg = joints_deg;
  return answers;
}

void check_files(const SetupArm& arm, const Cell& scene, const SetupPlaces& places, SetupCheck& check) {
  const SetupAnswers& answers = check.partial.answers;
  CellFiles files;
  try {
    files = cell_files(parked(answers, scene), arm, shipped_recipes(places.shipped_config));
    files[kSetupAnswersFile] = setup_document(answers);
    check_cell_files(files, places.temporary);
    demand_clear_park(answers, scene);
  } catch (const ConfigError& error) {
    note(check, error, files);
  }
  if (check.refused.empty()) check.files = std::move(files);
  check.passes = check.refused.empty();
}

}  // namespace

SetupCheck check_setup(const std::string& source, std::string_view text, const SetupPlaces& places,
                       const SetupLanguage& language) {
  SetupCheck check{.partial = read_partial_answers(source, text)};
  check.refused = check.partial.refused;
  const SetupAnswers& answers = check.partial.answers;
  if (!check.refused.empty()) check.passes = false;
  if (is_elsewhere(answers.arm)) {
    check.remarks.emplace_back(kArmElsewhere);
    return check;
  }
  const auto arm = shipped_arm(answers.arm, places, check);
  if (!arm) {
    check.passes = false;
    return check;
  }
  std::optional<Cell> scene;
  try {
    scene = setup_scene(answers, *arm);
    check.scene_svg = scene_svg(*scene, language.scene_titles);
    check.remarks = scene_remarks(*scene);
    check.remarks.insert(check.remarks.end(), arm->remarks.begin(), arm->remarks.end());
  } catch (const ConfigError& error) {
    note(check, error, {});
    check.passes = false;
    return check;
  }
  check_files(*arm, *scene, places, check);
  return check;
}

}  // namespace cell
