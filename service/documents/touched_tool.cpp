#include "service/documents/touched_tool.hpp"

#include <spdlog/fmt/fmt.h>

#include "calib_core/geometry/units.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/tool_document.hpp"

namespace cell {

std::variant<TouchedTool, std::string> touched_tool_of(const std::string& from, std::string_view result_json,
                                                       const std::string& of_run) try {
  if (schema_of(result_json) != ToolDocument().schema)
    return fmt::format("{} is no result of touchcal tool; touchcal runs lists the kinds", from);
  const ToolDocument tool = read_tool(result_json);
  if (!of_run.empty() && tool.of_run != of_run)
    return fmt::format(
        "{} touched the tool {} on the arm of run {}, and the model that is applied is that of run {}: touch "
        "it "
        "again, with touchcal tool {} --of {}",
        from, tool.tool, tool.of_run, of_run, tool.tool, of_run);
  if (!tool.verdict.accepted.value_or(false) || !tool.position_mm || !tool.world_box_rms_mm)
    return fmt::format("{} did not find the tip of the tool {}: touch it again", from, tool.tool);
  TouchedTool touched{
      .from = from,
      .tool = tool.tool,
      .position_m = calib::kMetresPerMillimetre * Eigen::Vector3d::Map(tool.position_mm->data()),
      .std_m = calib::metres_from_mm(*tool.world_box_rms_mm)};
  for (const ToolDocument::ArmError& error : tool.arm_errors) {
    const auto index = calib::error_parameter_index(error.name);
    if (!index) return fmt::format("{}: the arm has no error '{}'; touch the tool again", from, error.name);
    touched.arm_errors[*index] = calib::error_parameters()[static_cast<std::size_t>(*index)].is_length()
                                     ? calib::metres_from_mm(error.error)
                                     : error.error;
  }
  return touched;
} catch (const DocumentError& error) {
  return fmt::format("{} cannot be read: {}; touch the tool again", from, error.what());
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
