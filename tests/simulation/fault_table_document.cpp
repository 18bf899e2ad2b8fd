#include "tests/simulation/fault_table_document.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "service/run/fault_table.hpp"

namespace simulation {
namespace {

constexpr std::string_view kHeadingAt = "### ";
constexpr std::string_view kRowAt = "| ";
constexpr std::string_view kContradictionsAt = "## Contradictions";
constexpr std::string_view kAsWithout = "as if nothing had gone wrong |||||";

/// "1-3, 7".
std::string ranges_text(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += text.empty() ? "" : ", ";
    text += last == i ? fmt::format("{}", numbers[i]) : fmt::format("{}-{}", numbers[i], numbers[last]);
    i = last + 1;
  }
  return text;
}

std::size_t number_at(std::string_view text) {
  std::size_t number = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), number).ec != std::errc{})
    throw std::runtime_error(fmt::format("no number: '{}'", text));
  return number;
}

/// Of ranges_text().
std::vector<std::size_t> numbers_of(const std::string& text) {
  std::vector<std::size_t> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts >> std::ws, part, ',');) {
    const std::size_t dash = part.find('-');
    const std::size_t first = number_at(part);
    const std::size_t last =
        dash == std::string::npos ? first : number_at(std::string_view(part).substr(dash + 1));
    for (std::size_t number = first; number <= last; ++number) numbers.push_back(number);
  }
  return numbers;
}

std::string code_text(const std::string& code) { return code.empty() ? "-" : "`" + code + "`"; }

struct Counts {
  std::size_t made = 0, impossible = 0, as_without = 0;
  std::set<std::string> codes;
};

Counts counts_of(std::span<const TableRow> rows) {
  Counts counts;
  for (const TableRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      counts.codes.insert(row[i].codes.begin(), row[i].codes.end());
      ++(row[i].cell.cannot_happen.empty() ? counts.made : counts.impossible);
      if (&row != &rows.front() && row[i].cell == rows.front()[i].cell) ++counts.as_without;
    }
  }
  return counts;
}

std::string introduction(std::span<const TableRow> rows) {
  const Counts counts = counts_of(rows);
  return fmt::format(
      R"(# What goes wrong, at every step

Each cell of this table is a whole cell that was run: daemon, link, disk, controller and people in one process, in virtual time. At one step one thing goes
wrong; nobody repairs anything until nothing changes any more. That state is told here, with the code that is shown there and what the arm did. Then a person
comes, takes away what keeps the arm from moving, and gives the first command that the next step of the code names and the state takes, until a run is
complete. Everything below is written by `touchcal-sim --table` and compared by `simulation_test`; do not edit it by hand.

{} modes, {} steps: {} cells that were run, {} of them as if nothing had gone wrong; {} that cannot happen, each by the rule that stands there.

A cell by itself, with its journal: `touchcal-sim --cell MODE,STEP`. The same in full: `touchcal-sim --table --check service/doc/fault_modes.md`.

)",
      rows.size(), table_steps().size(), counts.made, counts.as_without, counts.impossible);
}

std::string steps_text() {
  std::string text = "## Steps\n\nA run has " + fmt::format("{}", kTouchesMin) +
                     " touches. A step is struck when this is seen on the wire, in the state or at the "
                     "disk.\n\n| step | | seen "
                     "|\n| --- | --- | --- |\n";
  std::size_t number = 0;
  for (const TableStep& step : table_steps()) {
    std::vector<std::string_view> sights;
    for (const ScriptStep& one : step.script) sights.push_back(one.sight);
    text += fmt::format("| {} | {} | {} |\n", ++number, step.name, fmt::join(sights, "; "));
  }
  return text;
}

std::string row_text(std::size_t number, const TableRow& row, const TableRow& without) {
  const TableMode& mode = table_modes()[number];
  std::string text = fmt::format("\n{}{} {}: {}{}\n\n", kHeadingAt, number, mode.group, mode.name,
                                 mode.modes.empty() ? "" : fmt::format(" ({})", mode.modes));
  text += "| steps | comes to rest | code shown | also told | the arm | the person gives | ends |\n";
  text += "| --- | --- | --- | --- | --- | --- | --- |\n";
  std::vector<std::pair<std::string, std::vector<std::size_t>>> groups;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string cell =
        number == 0 ? cell_text(row[i].cell, {}) : cell_text(row[i].cell, without[i].cell);
    auto group = std::ranges::find(groups, cell, [](const auto& one) { return one.first; });
    if (group == groups.end()) group = groups.insert(groups.end(), {cell, {}});
    group->second.push_back(i + 1);
  }
  for (const auto& [cell, steps] : groups)
    text += fmt::format("{}{} | {}\n", kRowAt, ranges_text(steps), cell);
  return text;
}

std::string contradictions_text(std::span<const TableRow> rows) {
  std::string text = "\n" + std::string(kContradictionsAt) +
                     "\n\nWhere what is told and what happened do not fit, found by the same run.\n\n";
  std::map<std::string, std::vector<std::string>> places;
  for (std::size_t mode = 0; mode < rows.size(); ++mode)
    for (std::size_t step = 0; step < rows[mode].size(); ++step)
      for (const std::string& what : rows[mode][step].contradictions)
        places[what].push_back(fmt::format("{},{}", mode, step + 1));
  if (places.empty()) return text + "None.\n";
  for (const auto& [what, cells] : places) text += fmt::format("- {}: {}\n", what, fmt::join(cells, "; "));
  return text;
}

std::string codes_text(std::span<const TableRow> rows) {
  std::string text =
      "\n## Codes\n\nAs `GET /api/v1/faults` tells them.\n\n| code | what the robot did | what to do next "
      "|\n| --- "
      "| --- | --- |\n";
  const std::set<std::string> codes = counts_of(rows).codes;
  for (const cell::FaultEntry& entry : cell::fault_table())
    if (codes.contains(std::string(entry.name)))
      text += fmt::format("| `{}` | {} | {} |\n", entry.name, entry.robot_action, entry.next_step);
  text += "\nCodes that no cell has:\n\n| code | why |\n| --- | --- |\n";
  for (const cell::FaultEntry& entry : cell::fault_table()) {
    if (codes.contains(std::string(entry.name))) continue;
    const auto reason = codes_without_cell().find(std::string(entry.name));
    text += fmt::format("| `{}` | {} |\n", entry.name,
                        reason == codes_without_cell().end() ? "?" : reason->second);
  }
  return text;
}

std::string modes_text() {
  std::map<std::string, std::vector<std::size_t>> rows;
  for (std::size_t number = 0; number < table_modes().size(); ++number) {
    std::istringstream names{std::string(table_modes()[number].modes)};
    for (std::string name; names >> name;) rows[name].push_back(number);
  }
  std::string text = "\n## P01 to P42\n\n| mode of probing | modes here |\n| --- | --- |\n";
  for (const auto& [name, numbers] : rows) text += fmt::format("| {} | {} |\n", name, ranges_text(numbers));
  text += "\nNo modes of this table:\n\n| mode of probing | tested in |\n| --- | --- |\n";
  for (const auto& [name, where] : modes_without_row()) text += fmt::format("| {} | {} |\n", name, where);
  return text;
}

}  // namespace

std::string cell_text(const TableCell& cell, const TableCell& without) {
  if (!cell.cannot_happen.empty()) return "cannot happen: " + cell.cannot_happen + " |||||";
  if (cell == without) return std::string(kAsWithout);
  const auto or_none = [](const std::string& text) { return text.empty() ? std::string("-") : text; };
  return fmt::format("{} | {} | {} | {} | {} | {} |", cell.rests, code_text(cell.shown), or_none(cell.told),
                     cell.arm, or_none(cell.person), cell.end);
}

std::string fault_table_document(std::span<const TableRow> rows) {
  std::string text = introduction(rows) + steps_text() + "\n## Modes\n";
  for (std::size_t number = 0; number < rows.size(); ++number)
    text += row_text(number, rows[number], rows.front());
  return text + contradictions_text(rows) + codes_text(rows) + modes_text();
}

std::map<CellNumber, std::string> cells_of_document(const std::string& document) {
  std::map<CellNumber, std::string> cells;
  std::istringstream lines(document);
  bool is_in_mode = false;
  std::size_t mode = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) is_in_mode = false;
    if (line.starts_with(kHeadingAt)) {
      is_in_mode = true;
      mode = number_at(std::string_view(line).substr(kHeadingAt.size()));
    }
    const bool is_row =
        is_in_mode && line.starts_with(kRowAt) && std::isdigit(static_cast<unsigned char>(line[2])) != 0;
    if (!is_row) continue;
    const std::size_t end = line.find(" | ");
    for (const std::size_t step : numbers_of(line.substr(kRowAt.size(), end - kRowAt.size())))
      cells[{mode, step}] = line.substr(end + 3);
  }
  return cells;
}

std::map<CellNumber, std::vector<std::string>> contradictions_of_document(const std::string& document) {
  std::map<CellNumber, std::vector<std::string>> found;
  std::istringstream lines(document);
  bool is_there = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) is_there = line == kContradictionsAt;
    if (!is_there || !line.starts_with("- ")) continue;
    const std::size_t end = line.rfind(": ");
    std::istringstream cells(line.substr(end + 2));
    for (std::string cell; std::getline(cells >> std::ws, cell, ';');) {
      const CellNumber number{number_at(cell), number_at(std::string_view(cell).substr(cell.find(',') + 1))};
      found[number].push_back(line.substr(2, end - 2));
    }
  }
  return found;
}

}  // namespace simulation
