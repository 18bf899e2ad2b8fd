#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "calib_core/identify.hpp"
#include "config/config_error.hpp"
#include "config/identification_problem.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/result_text.hpp"
#include "service/http/json_view.hpp"

namespace cell {
namespace {

const Recipe& recipe_named(const Cell& cell, const std::string& name) {
  const auto found = cell.recipes.find(name.empty() ? cell.default_recipe : name);
  if (found != cell.recipes.end()) return found->second;
  std::string known;
  for (const auto& [recipe, unused] : cell.recipes) known += (known.empty() ? "" : ", ") + recipe;
  throw ConfigError(cell.file.string(), "/recipes", "has no recipe " + in_quotes(name) + "; it has " + known);
}

}  // namespace

ExitCode identify_command(const IdentifyArguments& arguments, bool json) {
  const Cell cell = read_cell(arguments.cell_file);
  const Recipe& recipe = recipe_named(cell, arguments.recipe);
  const TouchesFile file = read_touches(arguments.touches_file, cell);
  calib::IdentificationProblem problem = identification_problem(cell, recipe);
  problem.touches = file.touches;
  const calib::IdentificationResult result = calib::identify(problem, recipe.identification);
  switch (result.status) {
    case calib::IdentificationStatus::kConverged:
      break;
    case calib::IdentificationStatus::kBadInput:
      fmt::print(stderr, "{}: {}\n", arguments.touches_file.string(), result.message);
      return kExitBadInput;
    default:
      fmt::print(stderr, "{}: {}\n", arguments.touches_file.string(), result.message);
      return kExitRefused;
  }
  const std::string document =
      result_document(cell, recipe, result, {.complete = true, .warnings = file.warnings});
  const auto parsed = nlohmann::json::parse(document);
  if (json) {
    fmt::print("{}\n", document);
  } else {
    for (const std::string& warning : file.warnings) fmt::print(stderr, "warning: {}\n", warning);
    fmt::print("{}", result_text(parsed));
  }
  return parsed.at("verdict").at("accepted").get<bool>() ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
