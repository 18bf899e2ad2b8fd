#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "service/cli/commands.hpp"

/// Options that more than one command of touchcal has, and those of commands that take no cell's file.
namespace cell {

CLI::Option* add_stiffness(CLI::App& command, std::string& choice);
/// Both or neither of --block-temperature and --std-block-temperature.
void add_block_temperature(CLI::App& command, TemperatureArguments& temperature);

/// The run, and the forms in which its arm is written.
void add_export_files(CLI::App& command, ExportArguments& arguments);

/// What is done to whom.
void add_users(CLI::App& command, UsersArguments& arguments);

/// The run, who approves it and for how long.
void add_approval(CLI::App& command, ApproveArguments& arguments);
/// What uses which model.
void add_application(CLI::App& command, AppliedArguments& arguments);

/// --archive, or the environment's.
void add_archive_url(CLI::App& command, std::string& url);
/// What an archive is compared with, for `archive`.
void add_verification(CLI::App& command, ArchiveArguments& arguments);
/// The history of one cell of an archive.
void add_history(CLI::App& command, ArchiveArguments& arguments);

/// --arm-moving, minutes.
void add_arm_moving(CLI::App& command, std::optional<double>& minutes);

/// Its form, its file, its simulated calibrations.
void add_report_options(CLI::App& report, ReportArguments& given);

}  // namespace cell
