#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/touched_places.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/cli/plan_text.hpp"
#include "service/cli/planning_bar.hpp"
#include "service/documents/places_view.hpp"
#include "service/documents/plan.hpp"

namespace cell {
namespace {

constexpr double kBoxMaxMetres = 100.0;

void set_workspace_box(Cell& cell, const std::vector<double>& box_mm) {
  if (box_mm.empty()) return;
  const Eigen::Vector3d min_m =
      calib::kMetresPerMillimetre * Eigen::Vector3d(box_mm[0], box_mm[1], box_mm[2]);
  const Eigen::Vector3d max_m =
      calib::kMetresPerMillimetre * Eigen::Vector3d(box_mm[3], box_mm[4], box_mm[5]);
  const bool is_sane = min_m.allFinite() && max_m.allFinite() && (max_m - min_m).maxCoeff() <= kBoxMaxMetres;
  if (!is_sane || !(min_m.array() < max_m.array()).all())
    throw std::invalid_argument(
        "--workspace-box: each minimum (the first three numbers) is below its maximum (the last three), by "
        "100 m at "
        "most");
  cell.workspace_box = {"as given", min_m, max_m};
}

/// The recipe with what the command line says in place of its own words.
Recipe wanted_recipe(const Cell& cell, const PlanArguments& arguments) {
  Recipe recipe = given_recipe(cell, arguments.cell);
  const auto faces = static_cast<int>(touched_faces(cell.block, recipe).size());
  const int own_count = recipe.fit_per_face > 0 ? recipe.fit_per_face * faces : recipe.goal.fit_count;
  if (arguments.fit_count || arguments.tip_rms_max_mm) {
    recipe.fit_per_face = 0;
    recipe.goal.fit_count = arguments.fit_count.value_or(own_count);
  }
  if (recipe.fit_per_face == 0 && recipe.goal.fit_count < faces)
    throw std::invalid_argument(
        fmt::format("--fit {}: the recipe {} touches {} planes; give as many touches at least",
                    recipe.goal.fit_count, recipe.name, faces));
  if (arguments.tip_rms_max_mm && !std::isfinite(*arguments.tip_rms_max_mm))
    throw std::invalid_argument("--accuracy: give a number of millimetres");
  if (arguments.tip_rms_max_mm) recipe.goal.tip_rms_max_m = calib::metres_from_mm(*arguments.tip_rms_max_mm);
  const auto criterion = std::ranges::find(kCriterionNames, arguments.criterion,
                                           &std::pair<calib::PlanCriterion, std::string_view>::second);
  if (criterion != kCriterionNames.end()) recipe.goal.criterion = criterion->first;
  return recipe;
}

ExitCode tell(const Cell& cell, const PlanRefusal& refusal) {
  fmt::print(stderr, "{}: {}\n", cell.file.string(), refusal.message);
  for (const std::string& line : effort_lines(refusal.efforts)) fmt::print(stderr, "  {}\n", line);
  return kExitRefused;
}

Eigen::Vector3d metres(const std::vector<double>& mm) {
  return calib::kMetresPerMillimetre * Eigen::Vector3d(mm[0], mm[1], mm[2]);
}

PlaceRange wanted_range(const PlanArguments& arguments) {
  if (arguments.place_min_mm.empty() || arguments.place_max_mm.empty())
    throw std::invalid_argument("--place: give --place-min and --place-max, the range of the block's shift");
  PlaceRange range{.min = {.shift_m = metres(arguments.place_min_mm)},
                   .max = {.shift_m = metres(arguments.place_max_mm)}};
  if (!arguments.place_yaw_deg.empty()) {
    range.min.yaw_rad = calib::radians_from_degrees(arguments.place_yaw_deg[0]);
    range.max.yaw_rad = calib::radians_from_degrees(arguments.place_yaw_deg[1]);
  }
  if (!(range.min.shift_m.array() <= range.max.shift_m.array()).all() ||
      range.min.yaw_rad > range.max.yaw_rad)
    throw std::invalid_argument("--place: a range begins at its smaller end");
  return range;
}

void give(const std::string& document, const std::string& text, const PlanArguments& arguments, bool json) {
  if (!arguments.file.empty()) write_whole_file(arguments.file, document + "\n", arguments.overwrite);
  fmt::print("{}", json ? document + "\n" : text);
}

ExitCode plan_places(const Cell& cell, const Recipe& recipe, const PlanArguments& arguments, bool json) {
  const PlaceRange range = wanted_range(arguments);
  PlanningBar bar(isatty(STDERR_FILENO) == 1);
  const auto findings =
      search_places(cell, recipe, range, {.place_count = arguments.place_count}, bar.progress());
  bar.finish();
  const PlacesDocument places = places_of(cell, recipe, findings);
  give(document_text(places), places_text(places), arguments, json);
  if (findings.front().figures) return kExitDone;
  fmt::print(stderr, "{}: at none of {} places there is a plan; where the block is now: {}\n",
             cell.file.string(), findings.size(),
             std::ranges::find(findings, true, &PlaceCandidate::present)->reason);
  return kExitRefused;
}

ExitCode plan_touches(const Cell& cell, const Recipe& recipe, const PlanArguments& arguments, bool json) {
  const TipRegions regions(cell);
  PlanningBar bar(isatty(STDERR_FILENO) == 1);
  const auto outcome = make_plan(regions, recipe, bar.progress());
  bar.finish();
  if (const auto* refusal = std::get_if<PlanRefusal>(&outcome)) return tell(cell, *refusal);
  const std::string& document = std::get<Plan>(outcome).document;
  give(document, plan_text(read_plan(document)), arguments, json);
  return kExitDone;
}

}  // namespace

ExitCode plan_command(const PlanArguments& arguments, bool json) {
  if (arguments.file == "-")
    throw std::invalid_argument("--out: standard output has the plan with --json; name a file");
  Cell cell = given_cell(arguments.cell);
  demand_revolute(cell);
  set_workspace_box(cell, arguments.workspace_box_mm);
  const Recipe recipe = wanted_recipe(cell, arguments);
  return arguments.place ? plan_places(cell, recipe, arguments, json)
                         : plan_touches(cell, recipe, arguments, json);
}

}  // namespace cell
