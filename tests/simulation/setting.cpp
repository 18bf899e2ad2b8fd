#include "tests/simulation/setting.hpp"

#include <malloc.h>

#include <set>
#include <stdexcept>
#include <string>
#include <variant>

#include "calib_core/kinematics/error_parameters.hpp"
#include "config/read_config.hpp"

namespace simulation {
namespace {

/// Errors that are not identified.
std::vector<int> all_but(const std::set<std::string>& names) {
  std::vector<int> excluded;
  for (int index = 0; index < calib::kErrorParameterCount; ++index)
    if (!names.contains(calib::arm_parameter_name(index))) excluded.push_back(index);
  return excluded;
}

/// An arm without errors but those that are identified: its file says so, and a healthy run is accepted.
void make_healthy(cell::Cell& cell, const std::vector<int>& excluded) {
  constexpr double kAlmostNone = 1e-6;  // metres, radians
  for (const int index : excluded) cell.arm.std_errors[static_cast<std::size_t>(index)] = kAlmostNone;
  // One touch a face is held out: of four faces one is off by more than two of its std now and then.
  cell.acceptance.held_out_mean_max_m = cell.acceptance.held_out_rms_max_m = 1e-4;
}

/// What the arm hides: the errors that the recipe identifies, and no others.
calib::ErrorVector hidden_errors() {
  calib::ErrorVector errors = calib::ErrorVector::Zero();
  const auto set = [&errors](const char* name, double error) {
    errors[calib::error_parameter_index(name).value()] = error;
  };
  set("r0", -2e-3);
  set("d1", 1.5e-3);
  set("r1", 1e-3);
  set("theta1", 2e-3);
  set("theta2", -1.5e-3);
  return errors;
}

cell::Cell simulated_cell() {
  cell::Cell made = cell::read_cell(std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json");
  cell::Recipe recipe = made.recipes.at("edf-25");
  recipe.name = kRecipe;
  recipe.fit_per_face = 7;
  recipe.held_out_per_face = 1;
  recipe.reference_every = 0;
  recipe.candidate_count = 2'000;
  recipe.identification.identifiability.excluded = all_but({"r0", "d1", "r1", "theta1", "theta2"});
  made.recipes.emplace(recipe.name, recipe);
  make_healthy(made, recipe.identification.identifiability.excluded);
  return made;
}

Setting make_setting(const cell::Cell& cell) {
  Setting made{
      .cell = cell, .plant = {}, .plan = nullptr, .regions = std::make_shared<cell::TipRegions>(cell)};
  made.plant = sim::make_plant(made.cell, hidden_errors());
  auto plan = cell::make_plan(*made.regions, made.cell.recipes.at(kRecipe));
  if (const auto* refusal = std::get_if<cell::PlanRefusal>(&plan))
    throw std::runtime_error("the simulated cell has no plan: " + refusal->message);
  made.plan = std::make_shared<const cell::Plan>(std::get<cell::Plan>(std::move(plan)));
  return made;
}

/// What a world frees the next one takes, and not the system in between.
void keep_memory() {
  constexpr int kKeptBytes = 256 * 1024 * 1024;
  mallopt(M_TRIM_THRESHOLD, kKeptBytes);
  mallopt(M_MMAP_THRESHOLD, kKeptBytes);
}

}  // namespace

const Setting& setting() {
  static const Setting made = [] {
    keep_memory();
    static const cell::Cell cell = simulated_cell();
    return make_setting(cell);
  }();
  return made;
}

std::shared_ptr<const cell::Plan> first_touches(const cell::Plan& plan, int count) {
  auto made = std::make_shared<cell::Plan>(plan);
  if (count >= static_cast<int>(plan.touches.touches.size())) return made;
  made->touches.touches.resize(static_cast<std::size_t>(count));
  made->document = "{\"first_touches\":" + std::to_string(count) + "}";
  made->id = plan.id + "-" + std::to_string(count);
  return made;
}

}  // namespace simulation
