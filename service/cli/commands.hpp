#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "service/base/exit_code.hpp"
#include "service/cli/api_client.hpp"

/// The commands of touchcal. Each prints to standard output (with `json` one document and nothing else),
/// reports errors on standard error and returns the exit code.
namespace cell {

/// The block's temperature in place of that of its file; both or neither.
struct TemperatureArguments {
  std::optional<double> celsius;
  std::optional<double> std_k;
};
/// Bounds of --monte-carlo.
inline constexpr int kMonteCarloMin = 100;
inline constexpr int kMonteCarloMax = 1'000'000;

/// The cell of a command that needs no daemon, and what the command line says in place of its files.
struct CellArguments {
  std::filesystem::path file;
  std::string recipe;     // the cell's default when empty
  std::string stiffness;  // "on", "off" or "auto"; the recipe's choice when empty
  TemperatureArguments block_temperature;
  std::chrono::system_clock::time_point now;  // by which a temperature of the block's file is old
};

struct IdentifyArguments {
  CellArguments cell;
  std::filesystem::path touches_file;
  std::optional<int> monte_carlo_count;  // simulated calibrations, if any are wanted
  std::string arm_file;                  // where the calibrated arm is written, if anywhere
  std::string map_file;    // where the map of the predicted uncertainty is written as CSV, if anywhere
  bool overwrite = false;  // those two
};
ExitCode identify_command(const IdentifyArguments& arguments, bool json);

struct ValidateArguments {
  CellArguments cell;
  std::filesystem::path touches_file;
  std::string other_file;  // touches of another set; the held-out ones when empty
};
/// The paper's validations; kExitLimitsMissed when the same touches give another arm.
ExitCode validate_command(const ValidateArguments& arguments, bool json);

/// Upper bound of --places.
inline constexpr int kFitCountMax = 2'000;
inline constexpr int kPlaceCountMax = 1'000;

struct PlanArguments {
  CellArguments cell;
  std::optional<int> fit_count;          // touches to fit over all planes, in place of the recipe's
  std::string criterion;                 // one of kCriterionNames; the recipe's when empty
  std::optional<double> tip_rms_max_mm;  // the fewest touches that reach it
  std::vector<double> workspace_box_mm;  // min and max, six numbers; the cell's when empty
  std::string file;                      // where the plan document is written, if anywhere
  bool overwrite = false;                // that one
  bool place = false;                    // search places of the block instead
  std::vector<double> place_min_mm;      // range of its shift, three numbers each
  std::vector<double> place_max_mm;
  std::vector<double> place_yaw_deg;  // range of its turn, two numbers; none when empty
  int place_count = 24;
};
/// Plans touches and reports the predicted figures, or ranks places of the block; kExitRefused without a plan
/// (at any place).
ExitCode plan_command(const PlanArguments& arguments, bool json);

struct SetupArguments {
  std::filesystem::path directory;
  std::filesystem::path answers_file;  // touchcal/setup/1; empty: they are asked for
  std::filesystem::path scene_file;    // .html or .svg, drawn after each answer; empty for none
  bool change = false;                 // the cell that is there, from its setup.json
  bool overwrite = false;              // also what was changed by hand since
  bool without_plans = false;          // limits of the shipped demo in place of those from plans
};
/// Makes or changes the directory of a cell from answers; kExitUsage where they end in the middle.
ExitCode setup_command(const SetupArguments& arguments, bool json);

struct SetupArmArguments {
  std::string name;
  std::filesystem::path urdf_file;  // with both links
  std::string base_link;
  std::string tip_link;
  std::filesystem::path dh_file;
  std::string dh_convention;  // of a table that does not say it
  std::string file;           // the arm's file; - is standard output
  bool overwrite = false;
};
/// Writes an arm's file that is made of a URDF robot or of a table of Denavit-Hartenberg parameters.
ExitCode setup_arm_command(const SetupArmArguments& arguments, bool json);

struct AppliedArm;  // applied_arm.hpp

struct CompensateArguments {
  std::filesystem::path cell_file;
  std::filesystem::path targets_file;
  std::string tool;                   // of the targets of a CSV, which names none; the stylus when empty
  std::optional<double> line_max_mm;  // how far the tool may be off a straight line; outranks the file
  std::string frame;       // of the poses of a list that leaves it open; the controller's world when empty
  std::string file;        // where the corrected targets are written, if anywhere
  std::string format;      // json, csv or robodk; when empty CSV by its name, else JSON
  bool overwrite = false;  // that one
};
/// Corrects targets for a calibrated arm; kExitLimitsMissed when a target is refused.
ExitCode compensate_command(const CompensateArguments& arguments, const AppliedArm& applied, bool json);

struct FilterArguments {
  std::filesystem::path cell_file;
  std::filesystem::path data_file;  // .dtx, with its programs and its project beside it
  std::filesystem::path list_file;  // which variables are filtered; the filter is marked in it
  std::filesystem::path file;       // the filtered data file
  bool overwrite = false;           // that one
};
/// Writes a VAL3 data file with its points and joints corrected for a calibrated arm, and tells what its
/// programs make of them; kExitLimitsMissed when a value is refused.
ExitCode filter_command(const FilterArguments& arguments, const AppliedArm& applied);

struct LibraryArguments {
  std::string file;      // the library's data file
  double flange_mm = 0;  // from the wrist's centre to the flange
};
/// Writes the numbers of the VAL3 library touchcal_abs for the calibrated arm; of `beside` cell and
/// overwrite.
ExitCode library_command(const LibraryArguments& arguments, const CompensateArguments& beside,
                         const AppliedArm& applied, std::chrono::system_clock::time_point now);

struct RunArguments {
  std::string recipe;         // of the cell, its default when empty; ignored with a plan
  std::string plan_id;        // of a plan of the daemon; empty for none
  std::string operator_name;  // may be empty
  std::string stiffness;      // "on", "off" or "auto"; the recipe's choice when empty
  bool guided = false;        // a person makes the touches with the pendant
  TemperatureArguments block_temperature;
  std::optional<double> arm_moving_min;
};
/// Starts a run and watches it to its end.
ExitCode run_command(const ApiClient& daemon, const RunArguments& arguments, bool json);

struct VerifyArguments {
  std::string kind;           // any but calibration
  std::string tool;           // of the kind tool
  std::string of_run;         // the calibration; the daemon's choice when empty
  std::string operator_name;  // may be empty
  TemperatureArguments block_temperature;
  std::optional<double> arm_moving_min;
};
/// Starts a run of another kind than a calibration and watches it to its end.
ExitCode verify_command(const ApiClient& daemon, const VerifyArguments& arguments, bool json);
/// Prints the checks of a calibration, the daemon's choice where `of_run` is empty, and when the next one is
/// due.
ExitCode checks_command(const ApiClient& daemon, const std::string& of_run, bool json);
/// Prints whether the arm has changed between two calibrations; kExitLimitsMissed when it has.
ExitCode compare_command(const ApiClient& daemon, const std::string& run, const std::string& other,
                         bool json);
/// Watches the run under way to its end, also if another one is started after it.
ExitCode watch_command(const ApiClient& daemon, bool json);
/// Locates the block: reports each touch that the person at the pendant has to make until the block is
/// located; given once more, follows the arm around it until the pose is accepted.
ExitCode locate_command(const ApiClient& daemon, bool json);
/// Prints the names that a shell completes, a line each: runs or recipes of the daemon; recipes or tools of a
/// cell's file.
ExitCode names_command(const ApiClient& daemon, const std::string& what);
ExitCode names_of_cell_command(const std::string& what, const std::filesystem::path& cell_file);
/// Prints the link that opens the operator's page with the token in it, for a browser on this machine.
ExitCode page_command(const ApiClient& daemon, bool json);
ExitCode status_command(const ApiClient& daemon, bool json);
ExitCode runs_command(const ApiClient& daemon, bool json);
ExitCode show_command(const ApiClient& daemon, const std::string& run_id, bool json);

struct ExportArguments {
  std::string run_id;
  std::string arm_file;   // as an arm file; empty for none, "-" is standard output
  std::string urdf_file;  // as a URDF robot; likewise
  std::string dh_file;    // as DH tables, JSON where the name ends in .json, else CSV; likewise
  bool overwrite = false;
};
/// Writes a run's calibrated arm in the forms that are asked for: all of them, or none where one cannot be
/// written.
ExitCode export_command(const ApiClient& daemon, const ExportArguments& arguments, bool json);

struct RunFileArguments {
  std::string run_id;  // to export
  std::string file;    // "-" is standard output
  bool overwrite = false;
};
/// Writes a run that is over with all that is stored of it, once it has verified itself.
ExitCode export_run_command(const ApiClient& daemon, const RunFileArguments& arguments, bool json);
/// Hands such a file to a daemon, once it has verified itself.
ExitCode import_run_command(const ApiClient& daemon, const std::string& file, bool json);

/// Upper bound of --valid-days.
inline constexpr int kValidDaysMax = 36'500;

struct ApproveArguments {
  std::string run_id;
  std::string operator_name;      // who approves it; may be empty
  std::optional<int> valid_days;  // from now; without it no end is set
};
/// Makes the model of an accepted run the cell's and prints it.
ExitCode approve_command(const ApiClient& daemon, const ApproveArguments& arguments, bool json);
/// Prints the cell's model, and below it the newest approvals and rollbacks, newest first.
ExitCode models_command(const ApiClient& daemon, bool json);
/// Takes the current model back and prints the one before, which is the cell's again.
ExitCode rollback_command(const ApiClient& daemon, const std::string& operator_name, bool json);

struct AppliedArguments {
  std::string to;             // what uses the model
  std::string hash;           // of a model that was approved; empty: of the cell's
  std::string operator_name;  // who says so; may be empty
};
/// Notes that what a model corrects is in use at the robot.
ExitCode applied_command(const ApiClient& daemon, const AppliedArguments& arguments, bool json);

/// Upper bound of --limit: all that the daemon keeps.
inline constexpr int kAuditLimitMax = 101'000;

/// Who may sign in.
struct UsersArguments {
  std::string action = "list";  // or "add", "remove"
  std::string name;
  std::string role;          // of who is added
  bool keep_secret = false;  // of who is there already: only the role changes
};
/// A secret is asked for on the terminal, or read as a line of standard input.
ExitCode users_command(const ApiClient& daemon, const UsersArguments& arguments, bool json);

struct AuditArguments {
  int limit = 50;
  bool csv = false;
};
/// Prints the newest rows of the audit log, newest first.
ExitCode audit_command(const ApiClient& daemon, const AuditArguments& arguments, bool json);

struct ArchiveArguments {
  std::string action;  // "prepare" or "verify"
  std::string url;
  bool without_touches = false;        // of verify: the archive does not get them
  std::string earlier;                 // of verify: a file of what it printed earlier with --json
  std::string cell;                    // of fleet: the history of this one; empty: all cells
  bool runs = false;                   // ... its runs, as the cell lists them, in place of its facts
  int limit = 50;                      // of the history: facts, or runs
  std::optional<std::int64_t> before;  // ... older than this number
  std::optional<int> months;           // of fleet: trends over so many by the type of arm
};
/// Makes the tables of an archive, or compares all that is in it with its digests; kExitBadInput for damage
/// and for a file of an earlier look that is none,
/// kExitUnreachable where the archive cannot be used.
ExitCode archive_command(const ArchiveArguments& arguments, bool json);
/// Prints the cells of an archive and what each told last, or what one told, or trends over all; kExitUsage
/// for one that the archive has never heard of.
ExitCode fleet_command(const ArchiveArguments& arguments, bool json);
/// What is wrong with the address of an archive; empty when nothing is.
std::string refuse_archive_url(const std::string& text);

struct ReportArguments {
  std::string run_id;
  std::string format = "html";  // html, csv or pdf
  std::string file = "-";       // "-" is standard output
  bool overwrite = false;
  std::string language = "en";           // of the HTML and the PDF: en, fr or de
  std::optional<int> monte_carlo_count;  // simulated calibrations, if any are wanted; the daemon draws them
};
/// Writes a run's report; with `json` its document on standard output, whatever the format.
ExitCode report_command(const ApiClient& daemon, const ReportArguments& arguments, bool json);

/// What give_command() takes, with what it does.
inline const std::map<std::string, std::string> kCellCommands{
    {"pause", "hold the run after the touch under way"},
    {"resume", "continue the run on hold"},
    {"abort", "end the run at once; the cell must be cleared afterwards"},
    {"stop", "stop motion and end the run"},
    {"acknowledge", "acknowledge the fault"},
    {"clear", "leave ABORTED once its cause is removed"},
    {"reset", "take the arm back from a face, make the cell ready for a run"},
    {"retry", "repeat the touch that holds the run"},
    {"skip", "leave out the touch that holds the run; the run is then incomplete"},
    {"confirm", "report what to confirm at the cell"},
    {"touch-test", "report the state of the touch test of the stylus"},
    {"take", "record the present contact, made by hand"},
    {"undo", "discard the last touch made by hand"},
};

/// pause, resume, abort, retry, skip: of the active run. stop, acknowledge, clear, reset, confirm,
/// touch-test, take, undo: of the cell.
ExitCode give_command(const ApiClient& daemon, const std::string& command, bool json);

/// Throws std::invalid_argument if this cannot be the id of a run.
void demand_run_id(const std::string& text);

}  // namespace cell
