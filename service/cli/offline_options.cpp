#include "service/cli/offline_options.hpp"

#include <CLI/CLI.hpp>

#include "config/decimal_text.hpp"
#include "config/option_text.hpp"
#include "config/recipe.hpp"
#include "config/targets_file.hpp"
#include "service/cli/shared_options.hpp"

namespace cell {
namespace {

void add_cell(CLI::App& command, CellArguments& given, const std::string& recipe_is) {
  command.add_option("--cell", given.file, "cell file")->required();
  command.add_option("--recipe", given.recipe, recipe_is + "; default: the cell's first");
  add_stiffness(command, given.stiffness);
  add_block_temperature(command, given.block_temperature);
}

}  // namespace

void add_options(CLI::App& command, IdentifyArguments& given) {
  add_cell(command, given.cell, "recipe whose identification options apply");
  command.add_option("--touches", given.touches_file, "touches, JSON or CSV")->required();
  command
      .add_option("--monte-carlo", given.monte_carlo_count,
                  "check the uncertainty by this many simulated calibrations (GUM, Supplement 1)")
      ->check(refuse_integer)
      ->check(CLI::Range(kMonteCarloMin, kMonteCarloMax));
  command.add_option("--export", given.arm_file, "write the calibrated arm to this arm file");
  command.add_option("--map", given.map_file,
                     "write the predicted uncertainty over the workspace box to this CSV file");
  command.add_flag("--force", given.overwrite, "overwrite these files");
}

void add_options(CLI::App& command, ValidateArguments& given) {
  add_cell(command, given.cell, "recipe whose identification options apply");
  command.add_option("--touches", given.touches_file, "touches, JSON or CSV")->required();
  command.add_option("--other", given.other_file,
                     "touches of another set; default: the held-out ones of --touches");
}

void add_options(CLI::App& command, PlanArguments& given) {
  add_cell(command, given.cell, "the recipe");
  command.add_option("--fit", given.fit_count, "touches to fit, over all planes, in place of the recipe's")
      ->check(refuse_integer)
      ->check(CLI::Range(1, kFitCountMax));
  std::vector<std::string> criteria;
  for (const auto& [unused, name] : kCriterionNames) criteria.emplace_back(name);
  command.add_option("--criterion", given.criterion, "criterion that the touches are chosen by")
      ->check(CLI::IsMember(criteria));
  command
      .add_option("--accuracy", given.tip_rms_max_mm,
                  "plan the fewest touches, at most --fit or the recipe's, with a predicted tip error within "
                  "this, mm")
      ->check(refuse_number)
      ->check(CLI::Range(1e-6, 1e3));
  command
      .add_option("--workspace-box", given.workspace_box_mm,
                  "box in which the tip error is predicted: minX,minY,minZ,maxX,maxY,maxZ in R_-1, mm")
      ->delimiter(',')
      ->check(refuse_number)
      ->expected(6);
  auto* place = command.add_flag("--place", given.place, "search places for the block and rank them");
  command
      .add_option("--place-min", given.place_min_mm,
                  "lower end of the block's shift, X,Y,Z along the present R_-1, mm")
      ->delimiter(',')
      ->check(refuse_number)
      ->expected(3)
      ->needs(place);
  command.add_option("--place-max", given.place_max_mm, "upper end of the block's shift, X,Y,Z, mm")
      ->delimiter(',')
      ->check(refuse_number)
      ->expected(3)
      ->needs(place);
  command
      .add_option("--place-yaw", given.place_yaw_deg,
                  "range of rotation about R_-1's y axis, MIN,MAX, degrees")
      ->delimiter(',')
      ->check(refuse_number)
      ->expected(2)
      ->needs(place);
  command.add_option("--places", given.place_count, "number of places to try")
      ->needs(place)
      ->check(refuse_integer)
      ->check(CLI::Range(1, kPlaceCountMax))
      ->default_str("24");
  command.add_option("--out", given.file, "write the document to this file");
  command.add_flag("--force", given.overwrite, "overwrite it");
}

void add_options(CLI::App& command, SetupArguments& given) {
  command.add_option("DIR", given.directory, "directory of the cell, new or with --change")->required();
  command.add_option("--answers", given.answers_file,
                     "take the answers of this file (touchcal/setup/1) and ask nothing");
  command.add_option(
      "--scene", given.scene_file,
      "draw the scene into this file after each answer: .html for a browser, which shows it anew, or .svg");
  auto* change = command.add_flag("--change", given.change,
                                  "change the cell that is there: its answers are the defaults");
  command
      .add_flag("--force", given.overwrite, "with --change: also where its files were changed by hand since")
      ->needs(change);
  command.add_flag("--no-plans", given.without_plans,
                   "take the shipped cell's limits of the tip and do not plan the recipes for them");
}

void add_options(CLI::App& command, SetupArmArguments& given) {
  command.add_option("NAME", given.name, "name of the arm")->required();
  auto* urdf = command.add_option("--urdf", given.urdf_file, "URDF file of the robot");
  auto* base =
      command.add_option("--base", given.base_link, "with --urdf: link below joint 1; the arm's R_-1")
          ->needs(urdf);
  auto* tip =
      command.add_option("--tip", given.tip_link, "with --urdf: link behind joint 6, z out of the flange")
          ->needs(urdf);
  urdf->needs(base)->needs(tip);
  auto* dh =
      command
          .add_option("--dh", given.dh_file,
                      "CSV of Denavit-Hartenberg parameters: of export --dh, or with columns theta,d,a,alpha")
          ->excludes(urdf);
  command
      .add_option("--dh-convention", given.dh_convention,
                  "standard or modified, of a table that does not say it")
      ->needs(dh)
      ->check(CLI::IsMember({"standard", "modified"}));
  command.add_option("--out", given.file, "the arm's file to write; - is standard output")->required();
  command.add_flag("--force", given.overwrite, "overwrite it");
}

void add_target_options(CLI::App& command, CompensateArguments& given, CLI::Option& data_file) {
  command.add_option("--tool", given.tool, "tool of the targets of a CSV or a RoboDK list; default: stylus")
      ->excludes(&data_file)
      ->check(refuse_empty);
  command
      .add_option(
          "--frame", given.frame,
          "frame of the poses of a RoboDK list: one of the target_frames of the cell's file; default: world")
      ->excludes(&data_file)
      ->check(refuse_empty);
  command
      .add_option(
          "--format", given.format,
          "form of --out: json, csv or robodk (a list of poses and joints); default: by its name, csv for "
          ".csv, else json")
      ->excludes(&data_file)
      ->check(CLI::IsMember({"json", "csv", "robodk"}));
  command
      .add_option("--line-max", given.line_max_mm,
                  "how far the tool may be off a straight line, mm, in place of the targets' line_max_mm; "
                  "default: 0.02")
      ->excludes(&data_file)
      ->check(refuse_number)
      ->check(CLI::Range(kLineMaxSmallestMm, kLineMaxLargestMm));
}

void add_beside_model(CLI::App& command, std::string& check_run, std::vector<std::string>& tool_runs,
                      std::vector<std::string>& tool_files, CLI::Option& model) {
  command
      .add_option("--check", check_run,
                  "the run of a check of that model's calibration: the growth of the arm that it found is "
                  "applied too")
      ->needs(&model);
  command
      .add_option(
          "--tool-run", tool_runs,
          "a run of touchcal tool on that model's arm: its tool is where it was touched and not where the "
          "cell's file has it; may be given once a tool")
      ->needs(&model)
      ->allow_extra_args(false);
  command
      .add_option("--tool-file", tool_files,
                  "the same from a file with the result of such a run, as show RUN --json prints it")
      ->allow_extra_args(false);
}

void add_library_options(CLI::App& command, LibraryArguments& given, CLI::Option& targets,
                         CLI::Option& data_file) {
  constexpr double kFlangeMaxMm = 1'000.0;
  auto* library = command.add_option("--library", given.file,
                                     "write the numbers of the VAL3 library touchcal_abs to this file, "
                                     "touchcal_abs.dtx, to correct points on the controller");
  auto* flange = command
                     .add_option("--flange-mm", given.flange_mm,
                                 "with --library: from the wrist's centre to the flange, mm; 100 on a TX90")
                     ->check(refuse_number)
                     ->check(CLI::Range(0.0, kFlangeMaxMm));
  library->excludes(&targets)->excludes(&data_file)->needs(flange);
  for (const char* of_targets : {"--out", "--json", "--tool", "--frame", "--format", "--line-max"})
    library->excludes(of_targets);
  flange->needs(library);
}

}  // namespace cell
