#include "service/cli/shared_options.hpp"

#include <CLI/CLI.hpp>

#include "config/block_file.hpp"
#include "config/decimal_text.hpp"
#include "config/json_value.hpp"
#include "config/option_text.hpp"
#include "service/archive/fleet_reader.hpp"
#include "service/run/run_conditions.hpp"
#include "service/run/simulated_calibrations.hpp"

namespace cell {

CLI::Option* add_stiffness(CLI::App& command, std::string& choice) {
  return command
      .add_option("--stiffness", choice,
                  "whether the compliance of the joints is estimated, in place of the recipe's choice; "
                  "auto: where the arm's file allows it")
      ->check(CLI::IsMember({"on", "off", "auto"}));
}

void add_block_temperature(CLI::App& command, TemperatureArguments& temperature) {
  auto* celsius = command
                      .add_option("--block-temperature", temperature.celsius,
                                  "temperature of the block, degrees C, in place of that of its file")
                      ->check(refuse_number)
                      ->check(CLI::Range(kBlockTemperatureMinC, kBlockTemperatureMaxC));
  auto* deviation =
      command.add_option("--std-block-temperature", temperature.std_k, "its standard deviation, K")
          ->check(refuse_number)
          ->check(CLI::Range(kPositive.min, kBlockTemperatureStdMaxK))
          ->needs(celsius);
  celsius->needs(deviation);
}

void add_arm_moving(CLI::App& command, std::optional<double>& minutes) {
  command
      .add_option("--arm-moving", minutes,
                  "minutes that the arm has moved at working speed before: how warm it is")
      ->check(refuse_number)
      ->check(CLI::Range(0.0, kArmMovingMaxMin));
}

void add_export_files(CLI::App& command, ExportArguments& arguments) {
  command.add_option("RUN", arguments.run_id, "id of the run")->required();
  command.add_option("--arm", arguments.arm_file, "write an arm file; - is standard output");
  command.add_option("--urdf", arguments.urdf_file, "write a URDF robot; - is standard output");
  command.add_option("--dh", arguments.dh_file,
                     "write DH tables, JSON to a FILE.json, else CSV; - is standard output");
  command.add_flag("--force", arguments.overwrite, "overwrite the files");
}

void add_users(CLI::App& command, UsersArguments& arguments) {
  command.add_option("ACTION", arguments.action, "list, add or remove; add also changes who is there")
      ->check(CLI::IsMember({"list", "add", "remove"}));
  command.add_option("USER", arguments.name, "the name to sign in with");
  command.add_option("--role", arguments.role, "what they may do: view, operate or engineer")
      ->check(CLI::IsMember({"view", "operate", "engineer"}));
  command.add_flag("--keep-secret", arguments.keep_secret, "change the role only, not the secret");
}

void add_approval(CLI::App& command, ApproveArguments& arguments) {
  command.add_option("RUN", arguments.run_id, "id of the run")->required();
  command.add_option("--operator", arguments.operator_name, "the person who approves it; stored with it");
  command.add_option("--valid-days", arguments.valid_days, "days from now until which it is valid")
      ->check(refuse_integer)
      ->check(CLI::Range(1, kValidDaysMax));
}

void add_application(CLI::App& command, AppliedArguments& arguments) {
  command.add_option("TO", arguments.to, "what uses the model: \"pick.dtx on the robot\"")->required();
  command.add_option("--model", arguments.hash,
                     "hash of an approved model, where it is not the one that is the cell's");
  command.add_option("--operator", arguments.operator_name, "the person who says so; stored with it");
}

void add_report_options(CLI::App& report, ReportArguments& given) {
  auto* html = report.add_flag_callback(
      "--html", [&given] { given.format = "html"; }, "one HTML document");
  auto* pdf = report.add_flag_callback(
      "--pdf", [&given] { given.format = "pdf"; }, "the same as PDF, printed by chromium");
  auto* csv = report.add_flag_callback(
      "--csv", [&given] { given.format = "csv"; }, "the touches as a table");
  html->excludes(pdf)->excludes(csv);
  pdf->excludes(csv);
  report.add_option("--language", given.language, "of the HTML and the PDF")
      ->check(CLI::IsMember({"en", "fr", "de"}))
      ->excludes(csv);
  report.add_option("--out", given.file, "the file to write; - is standard output")->default_str(given.file);
  report.add_flag("--force", given.overwrite, "overwrite the file");
  report
      .add_option("--monte-carlo", given.monte_carlo_count,
                  "with this many simulated calibrations beside the linear uncertainty")
      ->check(refuse_integer)
      ->check(CLI::Range(kReportDrawsMin, kReportDrawsMax));
}

void add_archive_url(CLI::App& command, std::string& url) {
  command.add_option("--archive", url, "postgresql://... of the archive; default: TOUCHCAL_ARCHIVE")
      ->check(CLI::Validator(refuse_archive_url, "URL"))
      ->envname("TOUCHCAL_ARCHIVE")
      ->required();
}

void add_verification(CLI::App& command, ArchiveArguments& arguments) {
  command.add_flag("--without-touches", arguments.without_touches,
                   "with verify: the archive is a head office that does not get them");
  command
      .add_option("--earlier", arguments.earlier,
                  "with verify: what it printed earlier with --json; what was there then must be there still")
      ->check(CLI::ExistingFile);
}

void add_history(CLI::App& command, ArchiveArguments& arguments) {
  constexpr int kFactsMax = 10'000;
  auto* cell = command.add_option("--cell", arguments.cell, "what this cell told, newest first")
                   ->check([](const std::string& name) {
                     return std::string(name.empty() ? "a name is missing" : "");
                   });
  command
      .add_flag("--runs", arguments.runs, "with --cell: its runs, as touchcal runs lists them at the cell")
      ->needs(cell);
  command.add_option("--limit", arguments.limit, "with --cell: so many facts (or runs) at most; default: 50")
      ->needs(cell)
      ->check(refuse_integer)
      ->check(CLI::Range(1, kFactsMax));
  command
      .add_option("--before", arguments.before,
                  "with --cell: only those before the fact (or run) of this number")
      ->needs(cell)
      ->check(refuse_count64);
  command
      .add_option(
          "--trends", arguments.months,
          "in place of the cells: what those with arms of one type told, a month each; so many months")
      ->excludes(cell)
      ->check(refuse_integer)
      ->check(CLI::Range(1, kTrendMonthsMax));
}

}  // namespace cell
