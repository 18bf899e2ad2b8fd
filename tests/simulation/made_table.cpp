#include "tests/simulation/made_table.hpp"

#include <spdlog/fmt/fmt.h>

#include <sstream>

namespace simulation {

std::vector<TableRow> make_table(std::FILE* progress) {
  std::vector<RestRecord> around;
  for (const TableStep& step : table_steps()) around.push_back(undisturbed(step));
  std::vector<TableRow> rows;
  for (const TableMode& mode : table_modes()) {
    TableRow row;
    for (std::size_t i = 0; i < around.size(); ++i)
      row.push_back(try_cell(mode, table_steps()[i], around[i]));
    rows.push_back(std::move(row));
    std::fprintf(progress, "%zu of %zu: %s, %s\n", rows.size(), table_modes().size(),
                 std::string(mode.group).c_str(), std::string(mode.name).c_str());
  }
  return rows;
}

std::string first_difference(const std::string& made, const std::string& given) {
  if (made == given) return {};
  std::istringstream made_lines(made), given_lines(given);
  for (int number = 1;; ++number) {
    std::string one, other;
    const bool is_there = static_cast<bool>(std::getline(made_lines, one));
    const bool is_other_there = static_cast<bool>(std::getline(given_lines, other));
    if (is_there && is_other_there && one == other) continue;
    return fmt::format("line {}:\n  given {}\n  made  {}", number, is_other_there ? other : "nothing",
                       is_there ? one : "nothing");
  }
}

}  // namespace simulation
