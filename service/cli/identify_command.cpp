#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "config/identification_problem.hpp"
#include "config/touches_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/cli/planning_bar.hpp"
#include "service/cli/result_text.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/configuration_digest.hpp"
#include "service/documents/result_view.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/run_conditions.hpp"
#include "service/run/run_repeats.hpp"
#include "service/run/simulated_calibrations.hpp"

namespace cell {
namespace {

/// The map as lines "x,y,z,mm", a cell each, its centre in R_-1; a cell out of reach has no figure.
std::string map_csv(const std::optional<TipDocument::Map>& found) {
  const TipDocument::Map& map = found.value();
  std::string lines = "x_mm,y_mm,z_mm,predicted_rms_mm\n";
  std::size_t index = 0;
  for (int z = 0; z < map.counts[2]; ++z) {
    for (int y = 0; y < map.counts[1]; ++y) {
      for (int x = 0; x < map.counts[0]; ++x, ++index) {
        const std::optional<double>& value = map.values_mm.at(index);
        lines += fmt::format("{:.6g},{:.6g},{:.6g},{}\n", map.box.min_mm[0] + (x + 0.5) * map.cell_mm[0],
                             map.box.min_mm[1] + (y + 0.5) * map.cell_mm[1],
                             map.box.min_mm[2] + (z + 0.5) * map.cell_mm[2],
                             value ? fmt::format("{:.6g}", *value) : "");
      }
    }
  }
  return lines;
}

void write_files(const IdentifyArguments& arguments, const Cell& cell,
                 const calib::IdentificationResult& result, const ResultDocument& document) {
  if (!arguments.map_file.empty())
    write_whole_file(arguments.map_file, map_csv(document.tip_uncertainty.map), arguments.overwrite);
  if (arguments.arm_file.empty()) return;
  write_whole_file(arguments.arm_file, calibrated_arm_document(cell, result), arguments.overwrite);
  print_warnings(export_warnings(cell.own_frames, document.verdict.accepted, document.verdict.reasons));
}

/// Sets what simulated calibrations tell, or the warning that there is nothing to draw from.
void simulate(const TipRegions& regions, const Recipe& recipe, const calib::IdentificationProblem& problem,
              const calib::IdentificationResult& result, int count, ResultContext& context) {
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  PlanningBar bar(isatty(STDERR_FILENO) != 0);
  context.monte_carlo = simulate_calibrations(
      regions, problem, recipe.identification, result, count, threads,
      [&bar, count](int done) { bar.show("simulated calibrations", static_cast<double>(done) / count); });
  bar.finish();
  if (auto missing = missing_draws(context.monte_carlo)) context.warnings.push_back(*std::move(missing));
}

}  // namespace

ExitCode identify_command(const IdentifyArguments& arguments, bool json) {
  if (arguments.arm_file == "-" || arguments.map_file == "-")
    throw std::invalid_argument("standard output has the result; name a file");
  const Cell cell = given_cell(arguments.cell);
  const Recipe recipe = given_recipe(cell, arguments.cell);
  TouchesFile file = read_touches(arguments.touches_file, cell, recipe);
  if (auto warning = temperature_warning(cell, arguments.cell.now))
    file.warnings.push_back(*std::move(warning));
  calib::IdentificationProblem problem = identification_problem(cell, recipe);
  problem.touches = file.touches;
  note_repeats(file.repeats, problem);
  const calib::IdentificationResult result = calib::identify(problem, recipe.identification);
  if (result.status != calib::IdentificationStatus::kConverged)
    return print_refusal(arguments.touches_file, result);
  const TipRegions regions(cell);
  ResultContext context{
      .complete = true,
      .warnings = file.warnings,
      .conditions = conditions_document(
          cell, {.config_digest = configuration_digest(cell),
                 .temperature_source = arguments.cell.block_temperature.celsius ? TemperatureSource::kRun
                                                                                : TemperatureSource::kFile})};
  if (arguments.monte_carlo_count)
    simulate(regions, recipe, problem, result, *arguments.monte_carlo_count, context);
  const ResultDocument document = result_of(regions, recipe, problem, result, context);
  write_files(arguments, cell, result, document);
  if (json) {
    fmt::print("{}\n", document_text(document));
  } else {
    print_warnings(file.warnings);
    fmt::print("{}", result_text(document));
  }
  return document.verdict.accepted ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
