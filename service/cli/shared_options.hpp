#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "service/cli/commands.hpp"

/// Options that more than one command of touchcal has.
namespace cell {

CLI::Option* add_stiffness(CLI::App& command, std::string& choice);
/// Both or neither of --block-temperature and --std-block-temperature.
void add_block_temperature(CLI::App& command, TemperatureArguments& temperature);

/// --arm-moving, minutes.
void add_arm_moving(CLI::App& command, std::optional<double>& minutes);

}  // namespace cell
