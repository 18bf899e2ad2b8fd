#include "service/cli/shared_options.hpp"

#include <CLI/CLI.hpp>

#include "config/block_file.hpp"
#include "config/decimal_text.hpp"
#include "config/json_value.hpp"
#include "config/option_text.hpp"
#include "service/run/run_conditions.hpp"

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

}  // namespace cell
