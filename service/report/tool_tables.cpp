// Where the tip of a tool was found, beside its limits.
#include <spdlog/fmt/fmt.h>

#include <vector>

#include "service/report/internal/report_parts.hpp"
#include "service/report/internal/verification_parts.hpp"

namespace cell {
namespace {

std::string position_text(const Words& words, const std::optional<std::array<double, 3>>& mm) {
  return mm ? words("{:.4f}, {:.4f}, {:.4f} mm", (*mm)[0], (*mm)[1], (*mm)[2]) : "–";
}

}  // namespace

std::string tool_tables(const Words& words, const ToolDocument& tool) {
  std::vector<html::Row> rows;
  const std::string limit = tool.box_rms_max_mm ? words.or_dash(tool.box_rms_max_mm, "at most {:g} mm")
                                                : words("no limit in the cell's file");
  const bool is_held = !tool.box_rms_max_mm || (tool.box_rms_mm && *tool.box_rms_mm <= *tool.box_rms_max_mm);
  rows.push_back({words("predicted error of the tip in the workspace box, rms"),
                  words.or_dash(tool.box_rms_mm, "{:.4f} mm"), limit, words(is_held ? "pass" : "fail")});
  const bool is_likely = !tool.p || !tool.p_min || *tool.p >= *tool.p_min;
  rows.push_back({words("chance of touches so far from their planes (p)"), words.or_dash(tool.p, "{:.3g}"),
                  words.or_dash(tool.p_min, "at least {:g}"), words(is_likely ? "pass" : "fail")});
  rows.push_back(told(words("tool"), tool.tool));
  rows.push_back(told(words("its tip in R6 (x, y, z)"), position_text(words, tool.position_mm)));
  rows.push_back(told(words("standard uncertainty of each"), position_text(words, tool.std_position_mm)));
  rows.push_back(told(words("its tip by the cell's file"), position_text(words, tool.drawn_mm)));
  rows.push_back(told(words("between both"), words.or_dash(tool.off_drawing_mm, "{:.4f} mm")));
  rows.push_back(
      told(words("distance of the touches from their planes, rms"), words.or_dash(tool.rms_mm, "{:.4f} mm")));
  rows.push_back(told(words("touches"), touches_text(words, tool.touch_count, tool.complete)));
  return figures_table(words, rows);
}

}  // namespace cell
