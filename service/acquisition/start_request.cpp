#include "service/acquisition/start_request.hpp"

namespace cell {

PlanGiven given_to(const StartRequest& request, const Cell& cell) {
  PlanGiven given{.block_temperature = request.block_temperature,
                  .stiffness = std::nullopt,
                  .verification = request.verification};
  if (request.stiffness) given.stiffness = is_estimated(*request.stiffness, cell.arm);
  return given;
}

Recipe recipe_of(const StartRequest& request, const Cell& cell) {
  const Recipe& named = cell.recipes.at(request.recipe);
  const Recipe recipe = request.stiffness ? with_stiffness(named, *request.stiffness, cell) : named;
  return request.verification ? verification_recipe(cell, recipe, request.kind) : recipe;
}

std::optional<std::string> stiffness_to_store(const StartRequest& request) {
  if (!request.stiffness) return std::nullopt;
  return std::string(name_of(*request.stiffness));
}

}  // namespace cell
