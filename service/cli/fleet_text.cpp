#include "service/cli/fleet_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "service/base/terminal_text.hpp"

namespace cell {
namespace {

/// Of a hash, in a table.
constexpr std::size_t kShownOfModel = 8;

using Row = std::vector<std::string>;

/// Characters, not bytes: the bytes that go on with one begin with 10.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(
      text, [](char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U; }));
}

/// Each column as wide as its widest field, two blanks between; no blanks at the end of a line.
std::string table(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const Row& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i]));
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += row[i];
      if (i + 1 < row.size()) text.append(widths[i] - width_of(row[i]) + 2, ' ');
    }
    text += '\n';
  }
  return text;
}

/// Whether the robot's programs were corrected with the cell's model, as a person said last.
std::string in_use(const FleetCell& cell) {
  if (!cell.applied_model) return "-";
  return cell.applied_model == cell.model ? "yes" : "other";
}

/// Of a time.
std::string day_in_table(const std::optional<std::string>& at) {
  constexpr std::size_t kDay = 10;
  return at ? table_field(at).substr(0, kDay) : "-";
}

/// A date that has passed.
std::string mark_late(bool is_late) { return is_late ? "!" : ""; }

std::string figure(std::optional<double> value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

Row row_of(const FleetCell& cell) {
  return {
      table_field(cell.cell),
      table_field(cell.state),
      table_field(cell.arm),
      day_in_table(cell.heard_at),
      day_in_table(cell.ended_at),
      table_field(cell.outcome == "complete" ? cell.verdict : cell.outcome),
      table_field(cell.model).substr(0, kShownOfModel),
      in_use(cell),
      figure(cell.tip_box_max_mm, 3),
      day_in_table(cell.valid_until) + mark_late(cell.model_over),
      cell.last_check_at
          ? day_in_table(cell.last_check_at) + " " +
                table_field(cell.last_check_cause ? cell.last_check_cause : cell.last_check_verdict)
          : "-",
      day_in_table(cell.check_due_at) + mark_late(cell.check_overdue),
      cell.last_fault_code ? day_in_table(cell.last_fault_at) + " " + table_field(cell.last_fault_code) : "-",
      cell.certificate_artefact
          ? table_field(cell.certificate_artefact) + " " + day_in_table(cell.certificate_valid_until) +
                mark_late(cell.certificate_over)
          : "-"};
}

}  // namespace

std::string table_field(const std::optional<std::string>& text) {
  std::string shown = terminal_text(text.value_or("-"));
  std::ranges::replace(shown, '\n', '?');
  return shown;
}

std::string fleet_text(const FleetDocument& fleet) {
  std::vector<Row> rows{{"cell", "state", "arm", "heard of", "last run", "result", "model", "in use",
                         "tip mm", "valid until", "check", "next check", "last fault", "certificate"}};
  std::ranges::transform(fleet.cells, std::back_inserter(rows), row_of);
  return table(rows) + "days in UTC, heard of by the archive's clock; ! is over\n";
}

std::string trends_text(const FleetTrendsDocument& document) {
  std::vector<Row> rows{{"month", "arm", "cells", "calibrations", "rejected", "approved", "tip mm", "checks",
                         "alarms", "growth ppm", "proofs", "failed", "faults"}};
  for (const FleetTrend& trend : document.trends) {
    rows.push_back({table_field(trend.month), trend.arm ? table_field(trend.arm) : "not known"});
    for (const auto count : {trend.cells, trend.calibrations, trend.rejected, trend.approved})
      rows.back().push_back(fmt::to_string(count));
    rows.back().push_back(figure(trend.tip_box_max_mm, 3));
    for (const auto count : {trend.checks, trend.alarms}) rows.back().push_back(fmt::to_string(count));
    rows.back().push_back(figure(trend.growth_ppm, 1));
    for (const auto count : {trend.proofs, trend.failed_proofs, trend.faults})
      rows.back().push_back(fmt::to_string(count));
  }
  return table(rows);
}

}  // namespace cell
