#include <spdlog/fmt/fmt.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "config/identification_problem.hpp"
#include "config/read_config.hpp"
#include "config/touches_file.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/cli/result_text.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/configuration_digest.hpp"
#include "service/documents/result_view.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/run_conditions.hpp"

namespace cell {
namespace {

/// The map as lines "x,y,z,mm", a cell each, its centre in R_-1; a cell out of reach has no figure.
std::string map_csv(const nlohmann::json& map) {
  const auto counts = map.at("counts").get<std::array<int, 3>>();
  const auto cell_mm = map.at("cell_mm").get<std::array<double, 3>>();
  const auto min_mm = map.at("box").at("min_mm").get<std::array<double, 3>>();
  std::string lines = "x_mm,y_mm,z_mm,predicted_rms_mm\n";
  std::size_t index = 0;
  for (int z = 0; z < counts[2]; ++z) {
    for (int y = 0; y < counts[1]; ++y) {
      for (int x = 0; x < counts[0]; ++x, ++index) {
        const nlohmann::json& value = map.at("values_mm").at(index);
        lines += fmt::format("{:.6g},{:.6g},{:.6g},{}\n", min_mm[0] + (x + 0.5) * cell_mm[0],
                             min_mm[1] + (y + 0.5) * cell_mm[1], min_mm[2] + (z + 0.5) * cell_mm[2],
                             value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : "");
      }
    }
  }
  return lines;
}

void write_files(const IdentifyArguments& arguments, const Cell& cell,
                 const calib::IdentificationResult& result, const nlohmann::json& document) {
  if (!arguments.map_file.empty()) {
    write_whole_file(arguments.map_file, map_csv(document.at("tip_uncertainty").at("map")),
                     arguments.overwrite);
  }
  if (arguments.arm_file.empty()) return;
  write_whole_file(arguments.arm_file, calibrated_arm_document(cell, result), arguments.overwrite);
  const nlohmann::json& verdict = document.at("verdict");
  print_warnings(export_warnings(cell.own_frames, verdict.at("accepted").get<bool>(),
                                 verdict.at("reasons").get<std::vector<std::string>>()));
}

}  // namespace

ExitCode identify_command(const IdentifyArguments& arguments, bool json) {
  if (arguments.arm_file == "-" || arguments.map_file == "-")
    throw std::invalid_argument("standard output has the result; name a file");
  const Cell cell = read_cell(arguments.cell_file);
  const Recipe& recipe = recipe_named(cell, arguments.recipe);
  const TouchesFile file = read_touches(arguments.touches_file, cell);
  calib::IdentificationProblem problem = identification_problem(cell, recipe);
  problem.touches = file.touches;
  const calib::IdentificationResult result = calib::identify(problem, recipe.identification);
  if (result.status != calib::IdentificationStatus::kConverged)
    return print_refusal(arguments.touches_file, result);
  const TipRegions regions(cell);
  const ResultContext context{
      .complete = true,
      .warnings = file.warnings,
      .conditions = conditions_document(cell, {.config_digest = configuration_digest(cell)})};
  const std::string document = result_document(regions, recipe, problem, result, context);
  const auto parsed = nlohmann::json::parse(document);
  write_files(arguments, cell, result, parsed);
  if (json) {
    fmt::print("{}\n", document);
  } else {
    print_warnings(file.warnings);
    fmt::print("{}", result_text(parsed));
  }
  return parsed.at("verdict").at("accepted").get<bool>() ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
