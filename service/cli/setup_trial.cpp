#include "service/cli/setup_trial.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <cmath>
#include <variant>

#include "calib_core/planning/candidate_pool.hpp"
#include "config/config_error.hpp"
#include "service/cli/planning_bar.hpp"
#include "service/documents/plan.hpp"
#include "service/documents/plan_document.hpp"
#include "service/run/planning_problem.hpp"

namespace cell {
namespace {

const char* answer_in_the_way(PlanRefusal::Kind kind) {
  switch (kind) {
    case PlanRefusal::Kind::kPark:
      return "/park_joints_deg";
    case PlanRefusal::Kind::kFace:
      return "/base";
    case PlanRefusal::Kind::kWorkspaceBox:
      return "/workspace_box";
    case PlanRefusal::Kind::kAccuracy:
    case PlanRefusal::Kind::kTouches:
      break;
  }
  return "/block/sides";
}

/// Half more than this; to two digits.
double with_room(double promised_mm) {
  constexpr double kRoom = 1.5;
  const double last = std::pow(10.0, std::floor(std::log10(kRoom * promised_mm)) - 1.0);
  return std::round(std::ceil(kRoom * promised_mm / last) * last * 1e6) / 1e6;
}

}  // namespace

RecipeTrial try_recipes(const Cell& cell, bool only_default) {
  RecipeTrial trial;
  const TipRegions regions(cell);
  for (const auto& [name, recipe] : cell.recipes) {
    const bool is_default = name == cell.default_recipe;
    if (only_default && !is_default) continue;
    PlanningBar bar(isatty(STDERR_FILENO) == 1);
    const auto outcome = make_plan(regions, recipe, bar.progress());
    bar.finish();
    if (const auto* refusal = std::get_if<PlanRefusal>(&outcome)) {
      if (is_default)
        throw ConfigError("recipe " + name, answer_in_the_way(refusal->kind),
                          "no plan can be made: " + refusal->message);
      trial.remarks.push_back(fmt::format("recipe {} has no plan: {}", name, refusal->message));
      continue;
    }
    const PlanDocument plan = read_plan(std::get<Plan>(outcome).document);
    const auto worst_mm = plan.tip_uncertainty.expanded.box_max_mm;
    if (worst_mm && *worst_mm > 0.0) trial.tip_box_max_mm[name] = with_room(*worst_mm);
  }
  return trial;
}

void demand_touchable_faces(const Cell& cell) {
  constexpr int kTouchesOfAFace = 40;
  const Recipe& recipe = cell.recipes.at(cell.default_recipe);
  for (calib::PlanningProblem problem : planning_problems(cell, recipe)) {
    problem.candidate_count = kTouchesOfAFace * static_cast<int>(problem.requests.size());
    for (const calib::FaceEffort& effort : calib::find_candidates(problem).efforts)
      if (effort.feasible == 0)
        throw ConfigError("answers", "/base",
                          fmt::format("{}; correct where base, block and boxes are, or touch another side",
                                      effort_lines({effort}).front()));
  }
}

}  // namespace cell
