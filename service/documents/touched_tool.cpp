#include "service/documents/touched_tool.hpp"

#include <spdlog/fmt/fmt.h>

#include "calib_core/geometry/units.hpp"
#include "calib_core/proof/tool_centre.hpp"
#include "config/config_error.hpp"
#include "service/documents/tool_document.hpp"

namespace cell {
namespace {

/// Figures of a file that went through a document.
constexpr double kSameDrawingMetres = 1e-9;

Eigen::Vector3d metres_of(const std::array<double, 3>& mm) {
  return calib::kMetresPerMillimetre * Eigen::Vector3d::Map(mm.data());
}

}  // namespace

std::variant<TouchedTool, std::string> touched_tool_of(const std::string& from,
                                                       std::string_view result_json) {
  if (schema_of(result_json) != ToolDocument().schema)
    return fmt::format("{} is no result of touchcal tool; touchcal runs lists the kinds", from);
  const ToolDocument tool = read_tool(result_json);
  if (!tool.verdict.accepted.value_or(false) || !tool.position_mm || !tool.world_box_rms_mm)
    return fmt::format("{} did not find the tip of the tool {}: touch it again", from, tool.tool);
  TouchedTool touched{.from = from,
                      .arm = tool.arm,
                      .tool = tool.tool,
                      .drawn_m = metres_of(tool.drawn_mm),
                      .position_m = metres_of(*tool.position_mm),
                      .std_m = calib::metres_from_mm(*tool.world_box_rms_mm)};
  for (const ToolDocument::ArmError& error : tool.arm_errors) {
    const auto index = calib::error_parameter_index(error.name);
    if (!index) return fmt::format("{}: the arm has no error '{}'; touch the tool again", from, error.name);
    const bool is_length = calib::error_parameters()[static_cast<std::size_t>(*index)].is_length();
    touched.arm_errors[*index] = is_length ? calib::metres_from_mm(error.error) : error.error;
  }
  return touched;
}

std::optional<std::string> why_other_calibration(const TouchedTool& touched,
                                                 const std::optional<std::string>& of_run,
                                                 const std::string& applied) {
  if (of_run == applied) return std::nullopt;
  return fmt::format(
      "{} touched the tool {} on the arm of run {}, and the arm that is applied is that of run {}: touch it "
      "again, with touchcal tool {} --of {}",
      touched.from, touched.tool, of_run.value_or("-"), applied, touched.tool, applied);
}

void demand_tool_of(const Cell& cell, const TouchedTool& touched) {
  const auto refuse = [&](const char* pointer, const std::string& what) {
    throw ConfigError(touched.from, pointer, what + "; touch the tool again, with touchcal tool");
  };
  if (touched.arm != cell.arm.name)
    refuse("/arm",
           fmt::format("is {} but the cell's arm is {}", in_quotes(touched.arm), in_quotes(cell.arm.name)));
  const auto tool = cell.tools.find(touched.tool);
  if (tool == cell.tools.end())
    refuse("/tool", fmt::format("is {}, which the cell does not have", in_quotes(touched.tool)));
  if ((touched.drawn_m - tool->second.translation()).norm() > kSameDrawingMetres)
    refuse("/drawn_mm", fmt::format("is not where the cell's file has the tool {} now", touched.tool));
  if ((touched.position_m - touched.drawn_m).norm() > calib::kToolDrawnWithinMetres)
    refuse("/position_mm", fmt::format("is over {:.0f} mm from drawn_mm",
                                       calib::mm_from_metres(calib::kToolDrawnWithinMetres)));
}

calib::CompensationTool as_touched(const calib::CompensationTool& drawn, const TouchedTool& touched) {
  calib::CompensationTool tool = drawn;
  tool.calibrated_frame6_from_tool.translation() = touched.position_m;
  tool.std_tip_m = touched.std_m;
  return tool;
}

calib::KinematicModel with_tool(const calib::KinematicModel& calibrated, const TouchedTool& touched) {
  return calib::apply(calibrated, touched.arm_errors);
}

CompensationDocument::Touched told_of(const TouchedTool& touched) {
  const Eigen::Vector3d mm = calib::mm_from_metres(1.0) * touched.position_m;
  return {.from = touched.from, .position_mm = {mm.x(), mm.y(), mm.z()}};
}

}  // namespace cell
