// Where the tip of a tool was found, beside its limits.
#include <spdlog/fmt/fmt.h>

#include <vector>

#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {
namespace {

std::string position_text(const std::optional<std::array<double, 3>>& mm) {
  return mm ? fmt::format("{:.4f}, {:.4f}, {:.4f} mm", (*mm)[0], (*mm)[1], (*mm)[2]) : "–";
}

}  // namespace

std::string tool_tables(const ToolDocument& tool) {
  std::vector<html::Row> rows;
  const std::string limit =
      tool.box_rms_max_mm ? or_dash(tool.box_rms_max_mm, "at most {:g} mm") : "no limit in the cell's file";
  const bool is_held = !tool.box_rms_max_mm || (tool.box_rms_mm && *tool.box_rms_mm <= *tool.box_rms_max_mm);
  rows.push_back({"predicted error of the tip in the workspace box, rms",
                  or_dash(tool.box_rms_mm, "{:.4f} mm"), limit, is_held ? "pass" : "fail"});
  const bool is_likely = !tool.p || !tool.p_min || *tool.p >= *tool.p_min;
  rows.push_back({"chance of touches so far from their planes (p)", or_dash(tool.p, "{:.3g}"),
                  or_dash(tool.p_min, "at least {:g}"), is_likely ? "pass" : "fail"});
  rows.push_back(told("tool", tool.tool));
  rows.push_back(told("its tip in R6 (x, y, z)", position_text(tool.position_mm)));
  rows.push_back(told("standard uncertainty of each", position_text(tool.std_position_mm)));
  rows.push_back(told("its tip by the cell's file", position_text(tool.drawn_mm)));
  rows.push_back(told("between both", or_dash(tool.off_drawing_mm, "{:.4f} mm")));
  rows.push_back(told("distance of the touches from their planes, rms", or_dash(tool.rms_mm, "{:.4f} mm")));
  rows.push_back(told("touches", std::to_string(tool.touch_count) + (tool.complete ? "" : ", not complete")));
  return figures_table(rows);
}

}  // namespace cell
