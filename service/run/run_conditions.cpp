#include "service/run/run_conditions.hpp"

#include <spdlog/fmt/fmt.h>

namespace cell {

std::string_view touch_mode_name(TouchMode touching) {
  switch (touching) {
    case TouchMode::kAutomatic:
      return "automatic";
    case TouchMode::kGuided:
      return "guided";
  }
  return "";
}

std::optional<std::string> unknown_temperature_reason(const Cell& cell) {
  if (cell.block.temperature_c) return std::nullopt;
  return fmt::format(
      "the temperature of the block {} is unknown; measure it and enter it in the block's file "
      "(temperature_c)",
      cell.block.name);
}

}  // namespace cell
