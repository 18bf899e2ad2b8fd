#include "config/mounted_tool.hpp"

#include <stdexcept>

#include "calib_core/kinematics/tool_frame.hpp"
#include "config/config_error.hpp"

namespace cell {

Cell with_tool_mounted(const Cell& cell, const std::string& tool) {
  const auto tip = cell.tool_tips.find(tool);
  if (tip == cell.tool_tips.end()) throw std::logic_error("the tool " + tool + " has no tip");
  Cell mounted = cell;
  calib::mount_tool(mounted.arm.model, cell.tools.at(tool));
  Probe& probe = mounted.probe;
  probe = Probe{.name = tool,
                .serial = {},
                .certificate = {},
                .stylus = {.radius_m = tip->second.radius_m},
                .std_stylus_radius_m = tip->second.std_radius_m,
                .overtravel_m = cell.probe.overtravel_m,
                .calibration_speed_m_s = cell.probe.calibration_speed_m_s,
                .bodies = {}};
  mounted.touch_noise_m = tip->second.noise_m;
  return mounted;
}

std::string why_no_tip(const Cell& cell, const std::string& tool) {
  std::string known;
  for (const auto& [name, unused] : cell.tool_tips) known += (known.empty() ? "" : ", ") + name;
  const std::string what = cell.tools.contains(tool) ? "the tool " + in_quotes(tool) + " has no \"tip\""
                                                     : "the cell has no tool " + in_quotes(tool);
  return what + (known.empty() ? "; add one with a \"tip\" to \"tools\" of the cell's file"
                               : "; those that can touch are " + known);
}

Truth with_tip_mounted(const Truth& truth, const TouchingTip& tip) {
  Truth mounted = truth;
  mounted.probe = {};
  mounted.probe.noise_m = tip.noise_m;
  return mounted;
}

}  // namespace cell
