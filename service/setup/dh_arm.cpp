#include "service/setup/dh_arm.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/file_bytes.hpp"
#include "config/json_value.hpp"

namespace cell {
namespace {

using calib::kFrameCount;
using calib::kJointCount;

constexpr const char* kDhForms =
    "give what touchcal export --dh writes, or six rows with the columns theta_deg,d_mm,a_mm,alpha_deg (or "
    "_rad, _m)";

struct DhRow {
  std::size_t line = 0;
  std::map<std::string, std::string, std::less<>> cells;  // by the heads of the columns
};

struct DhTable {
  std::string source;
  std::vector<std::string> heads;
  std::vector<DhRow> rows;

  [[noreturn]] void fail(std::size_t line, const std::string& message) const {
    throw ConfigError(source, "", line == 0 ? message : fmt::format("line {}: {}", line, message));
  }
  [[nodiscard]] bool has(std::string_view head) const {
    return std::ranges::find(heads, head) != heads.end();
  }
};

std::string stripped(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(stripped(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

DhTable read_table(const std::string& source, std::string_view text) {
  constexpr std::size_t kRowsMax = 100;
  DhTable table{.source = source};
  std::size_t number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string line = stripped(text.substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> cells = cells_of(line);
    if (table.heads.empty()) {
      table.heads = cells;
      continue;
    }
    if (cells.size() != table.heads.size())
      table.fail(number, fmt::format("has {} values for {} columns; separate them by commas", cells.size(),
                                     table.heads.size()));
    if (table.rows.size() == kRowsMax) table.fail(number, fmt::format("is one row too many; {}", kDhForms));
    DhRow row{.line = number};
    for (std::size_t i = 0; i < cells.size(); ++i) row.cells[table.heads[i]] = cells[i];
    table.rows.push_back(std::move(row));
  }
  return table;
}

double number_in(const DhTable& table, const DhRow& row, std::string_view head) {
  const std::string& text = row.cells.find(head)->second;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool is_number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
  if (!is_number || std::abs(value) > kNumberMax)
    table.fail(row.line, fmt::format("{} is {}; give a finite number below 100000", head, in_quotes(text)));
  return value;
}

/// A column by its name, in the unit that its name ends with.
double quantity(const DhTable& table, const DhRow& row, const std::string& name,
                const std::vector<std::pair<std::string, double>>& units) {
  for (const auto& [suffix, si] : units)
    if (table.has(name + suffix)) return si * number_in(table, row, name + suffix);
  if (table.has(name))
    table.fail(0, fmt::format("column {} has no unit, which is not guessed; name it {}{} or {}{}",
                              in_quotes(name), name, units[0].first, name, units[1].first));
  table.fail(0, fmt::format("has no column {}; {}", in_quotes(name), kDhForms));
}

double angle_in(const DhTable& table, const DhRow& row, const std::string& name) {
  return quantity(table, row, name, {{"_deg", calib::kRadiansPerDegree}, {"_rad", 1.0}});
}

double length_in(const DhTable& table, const DhRow& row, const std::string& name) {
  return quantity(table, row, name, {{"_mm", calib::kMetresPerMillimetre}, {"_m", 1.0}});
}

void take_turn(const DhTable& table, const DhRow& row, calib::LinkParameters& link) {
  link.theta_rad = angle_in(table, row, "theta");
  link.r_m = length_in(table, row, "d");
}

/// Quarter turns of radians that stand in a column of degrees: no arm has axes that are 1.57 degrees apart.
void demand_no_radians(const DhTable& table, const DhRow& row) {
  constexpr double kQuarterTolerance = 0.005;
  if (!table.has("alpha_deg")) return;
  const double alpha = std::abs(number_in(table, row, "alpha_deg"));
  if (std::abs(alpha - calib::kRadiansPerDegree * 90.0) < kQuarterTolerance)
    table.fail(row.line, fmt::format("alpha_deg is {:g}, which is a quarter turn in radians; name the column "
                                     "alpha_rad if the angles are, or write 90",
                                     alpha));
}

void take_link(const DhTable& table, const DhRow& row, calib::LinkParameters& link) {
  link.alpha_rad = angle_in(table, row, "alpha");
  link.d_m = length_in(table, row, "a");
  if (table.has("beta_deg")) link.beta_rad = angle_in(table, row, "beta");
}

std::vector<const DhRow*> rows_of(const DhTable& table, std::string_view convention) {
  std::vector<const DhRow*> rows;
  for (const DhRow& row : table.rows)
    if (row.cells.find("convention")->second == convention) rows.push_back(&row);
  return rows;
}

/// Rows 0 to 7 in order; rows 1 to 6 turn.
void demand_exported_rows(const DhTable& table, const std::vector<const DhRow*>& rows) {
  if (rows.size() != kFrameCount)
    table.fail(0,
               fmt::format("has {} rows of one convention; an exported table has rows 0 to 7", rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const DhRow& row = *rows[i];
    if (number_in(table, row, "row") != static_cast<double>(i))
      table.fail(row.line, fmt::format("is not row {}; rows stand in order from 0 to 7", i));
    const bool is_joint = i >= 1 && i <= kJointCount;
    const std::string& joint = row.cells.find("joint")->second;
    if (joint != (is_joint ? "revolute" : "fixed"))
      table.fail(row.line,
                 fmt::format("joint is {}; rows 1 to 6 are revolute, rows 0 and 7 fixed", in_quotes(joint)));
  }
}

calib::KinematicModel exported_model(const DhTable& table) {
  for (const char* head : {"row", "joint", "gain"})
    if (!table.has(head)) table.fail(0, fmt::format("has no column {}; {}", in_quotes(head), kDhForms));
  auto rows = rows_of(table, "modified");
  const bool is_modified = !rows.empty();
  if (!is_modified) rows = rows_of(table, "standard");
  demand_exported_rows(table, rows);
  calib::KinematicModel model;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    take_turn(table, *rows[i], model.links[i]);
    // By the standard convention the link behind a row's axis is in that row.
    const std::size_t link = is_modified ? i : i + 1;
    if (link < model.links.size()) take_link(table, *rows[i], model.links[link]);
    if (i >= 1 && i <= kJointCount) model.gains[i - 1] = number_in(table, *rows[i], "gain");
  }
  return model;
}

calib::KinematicModel plain_model(const DhTable& table, const std::string& convention) {
  if (convention != "standard" && convention != "modified")
    table.fail(0,
               "does not say of which convention it is; give --dh-convention standard (Rot z, Trans z, Trans "
               "x, Rot x) or "
               "modified (Rot x, Trans x, Rot z, Trans z)");
  if (table.rows.size() != kJointCount && table.rows.size() != kJointCount + 1)
    table.fail(
        0,
        fmt::format("has {} rows; an arm has six revolute joints, a row each, and may have a fixed tool in a "
                    "seventh",
                    table.rows.size()));
  calib::KinematicModel model;
  const bool is_modified = convention == "modified";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    demand_no_radians(table, table.rows[i]);
    take_turn(table, table.rows[i], model.links[i + 1]);
    const std::size_t link = is_modified ? i + 1 : i + 2;
    if (link < model.links.size()) {
      take_link(table, table.rows[i], model.links[link]);
    } else if (calib::LinkParameters last;
               take_link(table, table.rows[i], last), last.d_m != 0.0 || last.alpha_rad != 0.0) {
      table.fail(table.rows[i].line,
                 "a and alpha of a tool's row must be 0; put them into the row of joint 6");
    }
  }
  return model;
}

/// Where its axes are at 0, for bodies along them.
std::array<Eigen::Vector3d, kJointCount + 1> points_of(const calib::KinematicModel& model) {
  std::array<Eigen::Vector3d, kJointCount + 1> points_m;
  const calib::Chain chain = calib::forward_chain(model, calib::JointVector::Zero());
  for (std::size_t i = 0; i < points_m.size(); ++i) points_m[i] = chain.block_from_frame[i + 1].translation();
  return points_m;
}

}  // namespace

MadeArm arm_of_dh(const std::string& source, std::string_view text, const std::string& convention) {
  const DhTable table = read_table(source, text);
  if (table.rows.empty()) table.fail(0, fmt::format("has no rows; {}", kDhForms));
  ArmDescription description{
      .source = source,
      .unit_remedy = "Lengths in millimetres stand in columns d_mm and a_mm, in metres in d_m and a_m",
      .name = "arm",
      .ranges = assumed_ranges(),
      .speeds_max = assumed_speeds()};
  description.is_placed = table.has("convention");
  description.model = description.is_placed ? exported_model(table) : plain_model(table, convention);
  for (const double gain : description.model.gains)
    if (std::abs(gain) < 1e-3)
      table.fail(0, "has a joint without a gain; give 1, or -1 for one that counts backwards");
  description.joints_and_tip_m = points_of(description.model);
  return made_arm(
      description,
      {"the table has no ranges and speeds; -180 to 180 degrees and 180 degrees a second are assumed"});
}

MadeArm arm_of_dh_file(const std::filesystem::path& file, const std::string& convention) {
  return arm_of_dh(file.string(), read_file_bytes(file, kConfigFileSizeMax), convention);
}

}  // namespace cell
