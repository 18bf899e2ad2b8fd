// touchcal: the command line, for a daemon or offline.
#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <iostream>

#include "config/block_file.hpp"
#include "config/config_error.hpp"
#include "config/decimal_text.hpp"
#include "config/json_value.hpp"
#include "config/recipe.hpp"
#include "service/base/freed_memory.hpp"
#include "service/base/version.hpp"
#include "service/cli/applied_arm.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/completion.hpp"
#include "service/cli/daemon_choice.hpp"
#include "service/cli/nearest_word.hpp"
#include "service/cli/offline_options.hpp"
#include "service/cli/shared_options.hpp"

namespace {

class CommandLine {
 public:
  CommandLine() : app_("touchcal: calibrates a robot arm by touching a block", "touchcal") {
    app_.set_version_flag("--version", std::string("touchcal ") + cell::kVersion);
    app_.require_subcommand(1);
    add_offline("identify", "identify an arm from a file of touches (offline)", identify_,
                cell::identify_command);
    add_offline("validate", "identify again from the calibrated arm, and compare distances (offline)",
                validate_, cell::validate_command);
    add_offline("plan", "plan touches and predict their result (offline)", plan_, cell::plan_command);
    add_offline_without_cell("setup", "make or change the files of a cell by answering questions (offline)",
                             setup_, cell::setup_command);
    add_offline_without_cell("setup-arm", "make an arm's file from a URDF robot or a DH table (offline)",
                             setup_arm_, cell::setup_arm_command);
    add_compensate();
    add_run();
    add_verification(prove_, "prove",
                     "prove the calibrated arm: 12 touches on the block at another place, never fitted");
    add_verification(check_, "check",
                     "check the cell: 12 touches where the arm was calibrated, against the first ones");
    add_verification(qualify_, "qualify",
                     "qualify the probe: ten touches of one place, eight turns of the stylus, known lengths");
    auto* tool = add_verification(
        tool_, "tool", "find the tip of a tool: 8 touches with it, made by a person with the pendant");
    tool->add_option("NAME", tool_.tool, "one of the cell's tools that have a tip")->required();
    add_checks();
    add_compare();
    add_for_daemon("watch", "watch the run under way",
                   [this](const cell::ApiClient& daemon) { return cell::watch_command(daemon, json_); });
    add_for_daemon("status", "show the state of the cell",
                   [this](const cell::ApiClient& daemon) { return cell::status_command(daemon, json_); });
    add_for_daemon("page", "print the link that opens the operator's page",
                   [this](const cell::ApiClient& daemon) { return cell::page_command(daemon, json_); });
    add_for_daemon("runs", "list the runs, newest first",
                   [this](const cell::ApiClient& daemon) { return cell::runs_command(daemon, json_); });
    auto* show = add_for_daemon("show", "show one run and its result", [this](const cell::ApiClient& daemon) {
      return cell::show_command(daemon, run_id_, json_);
    });
    show->add_option("RUN", run_id_, "id of the run")->required();
    auto* exported = add_for_daemon(
        "export", "write a run's calibrated arm as an arm file, a URDF robot or DH tables",
        [this](const cell::ApiClient& daemon) { return cell::export_command(daemon, export_, json_); });
    cell::add_export_files(*exported, export_);
    add_report();
    add_models();
    add_run_files();
    add_audit();
    auto* users = add_for_daemon("users", "say who may sign in", [this](const cell::ApiClient& daemon) {
      return cell::users_command(daemon, users_, json_);
    });
    cell::add_users(*users, users_);
    add_archive();
    for (const auto& [name, description] : cell::kCellCommands) {
      add_for_daemon(name, description, [this, command = name](const cell::ApiClient& daemon) {
        return cell::give_command(daemon, command, json_);
      });
    }
    add_for_daemon("locate", "locate the block by six touches made by hand, then pass once around it",
                   [this](const cell::ApiClient& daemon) { return cell::locate_command(daemon, json_); });
    add_completion();
    add_names();
  }

  int run(int argc, char** argv) {
    if (argc > 1 && argv[1][0] != '-' && !is_command(argv[1])) return refuse_command(argv[1]);
    try {
      app_.parse(argc, argv);
      return action_();
    } catch (const CLI::ParseError& error) {
      return app_.exit(error, std::cout, std::cerr) == 0 ? cell::kExitDone : cell::kExitUsage;
    }
  }

 private:
  [[nodiscard]] bool is_command(const std::string& name) const {
    return !app_.get_subcommands([&](const CLI::App* command) { return command->get_name() == name; })
                .empty();
  }

  [[nodiscard]] int refuse_command(const std::string& typed) const {
    std::vector<std::string> names;
    for (const CLI::App* command : cell::shown_commands(app_)) names.push_back(command->get_name());
    const auto meant = cell::nearest_word(typed, names);
    std::cerr << "touchcal: there is no command '" << typed << "'"
              << (meant ? "; did you mean '" + *meant + "'?" : "") << "\ntouchcal --help lists them all\n";
    return cell::kExitUsage;
  }

  /// A command that needs no daemon.
  template <class Arguments>
  void add_offline(const std::string& name, const std::string& description, Arguments& given,
                   cell::ExitCode (*command)(const Arguments&, bool)) {
    given.cell.now = std::chrono::system_clock::now();
    add_offline_without_cell(name, description, given, command);
  }

  /// The same of one that reads no cell.
  template <class Arguments>
  void add_offline_without_cell(const std::string& name, const std::string& description, Arguments& given,
                                cell::ExitCode (*command)(const Arguments&, bool)) {
    auto* sub = app_.add_subcommand(name, description);
    cell::add_options(*sub, given);
    sub->add_flag("--json", json_, "one JSON document on standard output");
    sub->callback(
        [this, &given, command] { action_ = [this, &given, command] { return command(given, json_); }; });
  }

  void add_compensate() {
    auto* compensate =
        app_.add_subcommand("compensate", "correct the targets of a program for a calibrated arm (offline)");
    compensate->add_option("--cell", compensate_.cell_file, "cell file, with the nominal arm and the tools")
        ->required();
    auto* arm =
        compensate->add_option("--arm", arm_file_, "arm file of the calibrated arm, as export writes it");
    auto* model = compensate->add_option(
        "--model", model_,
        "approved model of the daemon in its place: current, its id or its hash (touchcal models)");
    arm->excludes(model);
    cell::add_beside_model(*compensate, check_run_, tool_runs_, tool_files_, *model);
    daemon_.add_to(*compensate);
    auto* targets = compensate->add_option("--targets", compensate_.targets_file, "targets, JSON or CSV");
    auto* data = compensate->add_option("--dtx", filter_.data_file,
                                        "VAL3 data file in place of targets, its programs beside it");
    auto* list = compensate->add_option("--list", filter_.list_file,
                                        "lines NAME offline|taught|leave [TOOL] for that data file");
    data->excludes(targets)->needs(list);
    list->needs(data);
    cell::add_target_options(*compensate, compensate_, *data);
    compensate->add_option("--out", compensate_.file,
                           "write the corrected targets to this file: a CSV when it ends in .csv, else JSON; "
                           "the filtered data file");
    compensate->add_flag("--force", compensate_.overwrite, "overwrite it");
    compensate->add_flag("--json", json_, "one JSON document on standard output")->excludes(data);
    cell::add_library_options(*compensate, library_, *targets, *data);
    compensate->callback(
        [this, compensate] { action_ = [this, compensate] { return compensate_or_filter(*compensate); }; });
  }

  /// The arm that is applied: a file's, or that of an approved model.
  cell::AppliedArm bare_arm(const CLI::App& command) const {
    if (!arm_file_.empty()) return cell::arm_of_file(arm_file_);
    if (model_.empty()) throw std::invalid_argument("compensate: give --arm FILE, or --model ID");
    return cell::arm_of_model(daemon_.client(command), model_, check_run_, std::chrono::system_clock::now());
  }
  cell::AppliedArm applied_arm(const CLI::App& command) const {
    cell::AppliedArm applied = bare_arm(command);
    for (const std::string& run : tool_runs_) cell::add_touched_run(daemon_.client(command), run, applied);
    for (const std::string& file : tool_files_) cell::add_touched_file(file, applied);
    return applied;
  }

  cell::ExitCode compensate_or_filter(const CLI::App& command) {
    if (!library_.file.empty())
      return cell::library_command(library_, compensate_, applied_arm(command),
                                   std::chrono::system_clock::now());
    if (filter_.data_file.empty()) {
      if (compensate_.targets_file.empty())
        throw std::invalid_argument("compensate: give --targets, --dtx with --list, or --library");
      return cell::compensate_command(compensate_, applied_arm(command), json_);
    }
    if (compensate_.file.empty() || compensate_.file == "-")
      throw std::invalid_argument("--out: name a file for the filtered data");
    filter_.cell_file = compensate_.cell_file;
    filter_.file = compensate_.file;
    filter_.overwrite = compensate_.overwrite;
    return cell::filter_command(filter_, applied_arm(command));
  }

  void add_run() {
    auto* run = add_for_daemon(
        "run", "start a run and watch it to its end",
        [this](const cell::ApiClient& daemon) { return cell::run_command(daemon, run_, json_); });
    auto* recipe =
        run->add_option("RECIPE", run_.recipe, "name of the recipe; default: the cell's default_recipe");
    run->add_option("--plan", run_.plan_id, "id of a plan of the daemon, in place of a recipe")
        ->excludes(recipe);
    run->add_flag("--guided", run_.guided, "a person makes the touches with the pendant");
    run->add_option("--operator", run_.operator_name,
                    "the person responsible for the run; stored with its result");
    cell::add_stiffness(*run, run_.stiffness)->excludes("--plan");
    cell::add_block_temperature(*run, run_.block_temperature);
    cell::add_arm_moving(*run, run_.arm_moving_min);
  }

  /// A run that is held against an earlier calibration.
  CLI::App* add_verification(cell::VerifyArguments& given, const std::string& name,
                             const std::string& description) {
    auto* run = add_for_daemon(name, description, [this, &given](const cell::ApiClient& daemon) {
      return cell::verify_command(daemon, given, json_);
    });
    run->add_option("--of", given.of_run, "id of the calibration's run; by default the one that counts");
    run->add_option("--operator", given.operator_name,
                    "the person responsible for the run; stored with its result");
    cell::add_block_temperature(*run, given.block_temperature);
    cell::add_arm_moving(*run, given.arm_moving_min);
    return run;
  }

  void add_checks() {
    auto* checks = add_for_daemon(
        "checks", "show what the checks of a calibration found, and when the next one is due",
        [this](const cell::ApiClient& daemon) { return cell::checks_command(daemon, run_id_, json_); });
    checks->add_option("--of", run_id_, "id of the calibration's run; by default the one that counts");
  }

  void add_compare() {
    auto* compare = add_for_daemon("compare", "say whether the arm has changed between two calibrations",
                                   [this](const cell::ApiClient& daemon) {
                                     return cell::compare_command(daemon, run_id_, other_run_id_, json_);
                                   });
    compare->add_option("RUN", run_id_, "id of the run of a calibration")->required();
    compare->add_option("OTHER", other_run_id_, "id of another one")->required();
  }

  void add_report() {
    auto* report = add_for_daemon(
        "report", "write the report of a run, as HTML by default",
        [this](const cell::ApiClient& daemon) { return cell::report_command(daemon, report_, json_); });
    report->add_option("RUN", report_.run_id, "id of the run")->required();
    cell::add_report_options(*report, report_);
  }

  void add_models() {
    auto* approve = add_for_daemon(
        "approve", "make the model of a run that is complete and accepted the cell's",
        [this](const cell::ApiClient& daemon) { return cell::approve_command(daemon, approve_, json_); });
    cell::add_approval(*approve, approve_);
    auto* applied = add_for_daemon(
        "applied", "note that what the cell's model corrects is in use at the robot; the plant hears of it",
        [this](const cell::ApiClient& daemon) { return cell::applied_command(daemon, applied_, json_); });
    cell::add_application(*applied, applied_);
    add_for_daemon("models", "show the cell's model; what was approved, rolled back, applied, newest first",
                   [this](const cell::ApiClient& daemon) { return cell::models_command(daemon, json_); });
    auto* rollback =
        add_for_daemon("rollback", "take the cell's model back; the one before is the cell's again",
                       [this](const cell::ApiClient& daemon) {
                         return cell::rollback_command(daemon, approve_.operator_name, json_);
                       });
    rollback->add_option("--operator", approve_.operator_name,
                         "the person who takes it back; stored with it");
  }

  void add_run_files() {
    auto* exported = add_for_daemon(
        "export-run", "write a run that is over with all that is stored of it, for another daemon",
        [this](const cell::ApiClient& daemon) { return cell::export_run_command(daemon, run_file_, json_); });
    exported->add_option("RUN", run_file_.run_id, "id of the run")->required();
    exported->add_option("FILE", run_file_.file, "the file to write; - is standard output")->required();
    exported->add_flag("--force", run_file_.overwrite, "overwrite the file");
    auto* imported = add_for_daemon(
        "import-run", "take in a run that another daemon exported; it becomes no model of the cell by that",
        [this](const cell::ApiClient& daemon) {
          return cell::import_run_command(daemon, run_file_.file, json_);
        });
    imported->add_option("FILE", run_file_.file, "a file that export-run wrote")->required();
  }

  void add_archive_url(CLI::App& command) {
    cell::add_archive_url(command, archive_.url);
    command.add_flag("--json", json_, "one JSON document on standard output");
  }

  void add_archive() {
    auto* archive = app_.add_subcommand("archive", "prepare or verify the archive of many cells");
    archive->add_option("ACTION", archive_.action, "prepare: make its tables; verify: find what was changed")
        ->check(CLI::IsMember({"prepare", "verify"}))
        ->required();
    add_archive_url(*archive);
    cell::add_verification(*archive, archive_);
    archive->callback([this] { action_ = [this] { return cell::archive_command(archive_, json_); }; });
    auto* fleet = app_.add_subcommand("fleet", "list the cells of the archive and what each told last");
    add_archive_url(*fleet);
    cell::add_history(*fleet, archive_);
    fleet->callback([this] { action_ = [this] { return cell::fleet_command(archive_, json_); }; });
  }

  void add_audit() {
    auto* audit = add_for_daemon(
        "audit", "list the audit log, newest first: who gave which command, from where, and what came of it",
        [this](const cell::ApiClient& daemon) { return cell::audit_command(daemon, audit_, json_); });
    audit->add_option("--limit", audit_.limit, "number of rows")
        ->check(cell::refuse_integer)
        ->check(CLI::Range(1, cell::kAuditLimitMax))
        ->default_str("50");
    audit->add_flag("--csv", audit_.csv, "as a table for other programs")
        ->excludes(audit->get_option("--json"));
  }

  void add_completion() {
    auto* completion = app_.add_subcommand("completion", "print a shell completion script for touchcal");
    completion->add_option("SHELL", shell_, "bash or zsh")->required()->check(CLI::IsMember({"bash", "zsh"}));
    completion->callback([this] {
      action_ = [this] {
        std::cout << cell::completion_script(app_, shell_);
        return cell::kExitDone;
      };
    });
  }

  /// What the script asks for what is completed.
  void add_names() {
    auto* names = app_.add_subcommand("names", "print the names of runs, recipes or tools, for the shell");
    names->group("");  // it is for the script alone
    names->add_option("WHAT", names_of_, "runs, recipes or tools")->required();
    names->add_option("--cell", names_cell_, "the cell's file");
    daemon_.add_to(*names);
    names->callback([this, names] {
      action_ = [this, names] {
        return names_cell_.empty() ? cell::names_command(daemon_.client(*names), names_of_)
                                   : cell::names_of_cell_command(names_of_, names_cell_);
      };
    });
  }

  CLI::App* add_for_daemon(const std::string& name, const std::string& description,
                           const std::function<cell::ExitCode(const cell::ApiClient&)>& command) {
    auto* sub = app_.add_subcommand(name, description);
    daemon_.add_to(*sub);
    sub->add_flag("--json", json_, "one JSON document on standard output");
    sub->callback(
        [this, sub, command] { action_ = [this, sub, command] { return command(daemon_.client(*sub)); }; });
    return sub;
  }

  CLI::App app_;
  std::function<cell::ExitCode()> action_;
  cell::IdentifyArguments identify_;
  cell::ValidateArguments validate_;
  cell::PlanArguments plan_;
  cell::SetupArguments setup_;
  cell::SetupArmArguments setup_arm_;
  cell::CompensateArguments compensate_;
  cell::FilterArguments filter_;
  cell::LibraryArguments library_;
  std::string arm_file_, model_;  // what compensate applies: one of the two
  std::string check_run_;
  cell::ExportArguments export_;
  cell::ReportArguments report_;
  cell::RunFileArguments run_file_;
  cell::AuditArguments audit_;
  cell::UsersArguments users_;
  cell::ArchiveArguments archive_;
  cell::ApproveArguments approve_;
  cell::AppliedArguments applied_;
  cell::DaemonChoice daemon_;
  cell::RunArguments run_;
  std::vector<std::string> tool_runs_, tool_files_;  // tools that were touched
  cell::VerifyArguments prove_{.kind = "proof"}, check_{.kind = "check"}, qualify_{.kind = "qualification"},
      tool_{.kind = "tool"};
  std::string shell_, run_id_, other_run_id_;
  std::string names_of_, names_cell_;
  bool json_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  cell::keep_freed_memory();
  try {
    return CommandLine().run(argc, argv);
  } catch (const cell::ConfigError& error) {
    std::cerr << error.what() << '\n';
    return cell::kExitBadInput;
  } catch (const cell::ModelRefused& error) {
    std::cerr << error.what() << '\n';
    return cell::kExitRefused;
  } catch (const cell::DaemonUnreachable& error) {
    std::cerr << error.what() << '\n';
    return cell::kExitUnreachable;
  } catch (const std::invalid_argument& error) {
    std::cerr << error.what() << '\n';
    return cell::kExitUsage;
  } catch (const std::exception& error) {
    std::cerr << "touchcal: " << error.what() << '\n';
    return cell::kExitFailed;
  }
}
