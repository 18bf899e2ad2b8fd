#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "calib_core/identification/identify.hpp"
#include "config/identification_problem.hpp"
#include "service/documents/result_view.hpp"
#include "tests/service/shipped_cell.hpp"

/// Result documents of the paper's cell and the touches of an arm with the errors of Table III.
namespace cell {

using nlohmann::json;

inline const TipRegions& regions() {
  static const TipRegions of_edf(edf());
  return of_edf;
}

inline json document_of(const calib::IdentificationProblem& problem,
                        const calib::IdentificationResult& identified, const ResultContext& context = {}) {
  return json::parse(result_document(regions(), edf().recipes.at("edf-25"), problem, identified, context));
}

inline calib::IdentificationProblem problem_of(const Recipe& recipe) {
  calib::IdentificationProblem problem = identification_problem(edf(), recipe);
  problem.touches = table3_touches();
  return problem;
}

inline json result_with(const Recipe& recipe) {
  const calib::IdentificationProblem problem = problem_of(recipe);
  const auto identified = calib::identify(problem, recipe.identification);
  return json::parse(result_document(regions(), recipe, problem, identified, {}));
}

/// Of the paper's touches with the cell's default recipe.
inline const json& result() {
  static const json document = result_with(edf().recipes.at("edf-25"));
  return document;
}

inline const json& parameter(const std::string& name) {
  for (const json& found : result().at("parameters")) {
    if (found.at("name") == name) return found;
  }
  throw std::out_of_range("no parameter " + name);
}

}  // namespace cell
