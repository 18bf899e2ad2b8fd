#include <spdlog/fmt/fmt.h>

#include <cstdio>

#include "calib_core/identification/validate.hpp"
#include "config/identification_problem.hpp"
#include "config/touches_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/cli/validation_text.hpp"
#include "service/documents/validation_view.hpp"
#include "service/run/block_temperature.hpp"

namespace cell {

ExitCode validate_command(const ValidateArguments& arguments, bool json) {
  const Cell cell = given_cell(arguments.cell);
  const Recipe recipe = given_recipe(cell, arguments.cell);
  TouchesFile file = read_touches(arguments.touches_file, cell, recipe);
  if (auto warning = temperature_warning(cell, arguments.cell.now))
    file.warnings.push_back(*std::move(warning));
  TouchesFile other;
  if (!arguments.other_file.empty()) other = read_touches(arguments.other_file, cell, recipe);
  if (!arguments.other_file.empty() && other.touches.empty()) {
    fmt::print(stderr, "{}: has no touches to validate with; give the other set\n", arguments.other_file);
    return kExitRefused;
  }
  calib::IdentificationProblem problem = identification_problem(cell, recipe);
  problem.touches = file.touches;
  const calib::Validation validation = calib::validate(problem, recipe.identification, other.touches);
  if (validation.result.status != calib::IdentificationStatus::kConverged)
    return print_refusal(arguments.touches_file, validation.result);
  ValidationDocument document = validation_of(cell, recipe, problem, validation);
  if (json) {
    for (const auto* warnings : {&file.warnings, &other.warnings})
      document.warnings.insert(document.warnings.end(), warnings->begin(), warnings->end());
    fmt::print("{}\n", document_text(document));
  } else {
    print_warnings(file.warnings);
    print_warnings(other.warnings);
    fmt::print("{}", validation_text(document));
  }
  if (!arguments.other_file.empty() && !validation.other_touches.done()) {
    fmt::print(stderr, "{}: {}\n", arguments.other_file, validation.other_touches.message);
    return kExitRefused;
  }
  return validation.passed() ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
