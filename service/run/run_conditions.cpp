#include "service/run/run_conditions.hpp"

#include <spdlog/fmt/fmt.h>

namespace cell {

std::optional<std::string> temperature_gap(const Cell& cell) {
  if (cell.block.temperature_c) return std::nullopt;
  return fmt::format(
      "nobody says how warm the block {} is; measure it and give it in the block's file (temperature_c)",
      cell.block.name);
}

}  // namespace cell
