#include "service/run/run_recipe.hpp"

#include "config/stiffness_choice.hpp"

namespace cell {

Recipe recipe_of(const StoredRun& run, const Cell& cell) {
  const Recipe& recipe = cell.recipes.at(run.recipe);
  const auto choice = stiffness_choice_named(run.stiffness.value_or(""));
  return choice ? with_stiffness(recipe, *choice, cell) : recipe;
}

}  // namespace cell
