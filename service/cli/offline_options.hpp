#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "service/cli/commands.hpp"

/// The options of the commands that need no daemon; touchcal adds --json.
namespace cell {

void add_options(CLI::App& command, IdentifyArguments& given);
void add_options(CLI::App& command, ValidateArguments& given);
void add_options(CLI::App& command, PlanArguments& given);
void add_options(CLI::App& command, SetupArguments& given);
void add_options(CLI::App& command, SetupArmArguments& given);

/// What is said of the targets of compensate; none of it counts for a data file in their place.
void add_target_options(CLI::App& command, CompensateArguments& given, CLI::Option& data_file);

/// What is applied beside a `model`: the growth that a check found, and tools that were touched, by runs of
/// the daemon or by files.
void add_beside_model(CLI::App& command, std::string& check_run, std::vector<std::string>& tool_runs,
                      std::vector<std::string>& tool_files, CLI::Option& model);

/// --library in place of targets and data file, with what it needs.
void add_library_options(CLI::App& command, LibraryArguments& given, CLI::Option& targets,
                         CLI::Option& data_file);

}  // namespace cell
