#pragma once

#include <CLI/App.hpp>

#include "service/cli/commands.hpp"

/// The options of the commands that need no daemon; touchcal adds --json.
namespace cell {

void add_options(CLI::App& command, IdentifyArguments& given);
void add_options(CLI::App& command, ValidateArguments& given);
void add_options(CLI::App& command, PlanArguments& given);

/// What is said of the targets of compensate; none of it counts for a data file in their place.
void add_target_options(CLI::App& command, CompensateArguments& given, CLI::Option& data_file);

}  // namespace cell
