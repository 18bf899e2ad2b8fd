#include "service/documents/internal/tool_view.hpp"

#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/internal/verdict_word.hpp"
#include "service/documents/tool_document.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

std::array<double, 3> in_mm(const Eigen::Vector3d& metres) {
  return {mm_from_metres(metres.x()), mm_from_metres(metres.y()), mm_from_metres(metres.z())};
}

void tell_tool(const calib::ToolVerdict& verdict, const calib::ToolTip& tip,
               const std::vector<calib::Touch>& touches, ToolDocument& document) {
  document.verdict = {.accepted = verdict.passed, .reasons = verdict.reasons};
  document.position_mm = in_mm(verdict.centre_m);
  document.std_position_mm = in_mm(verdict.covariance_m2.diagonal().cwiseMax(0.0).cwiseSqrt());
  document.off_drawing_mm = finite(mm_from_metres((verdict.centre_m - tip.drawn_m).norm()));
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    if (verdict.arm_errors[i] == 0.0) continue;
    const bool is_length = calib::error_parameters()[static_cast<std::size_t>(i)].is_length();
    document.arm_errors.push_back(
        {.name = calib::arm_parameter_name(i),
         .unit = is_length ? "mm" : "rad",
         .error = is_length ? mm_from_metres(verdict.arm_errors[i]) : verdict.arm_errors[i]});
  }
  document.box_rms_mm = finite_mm(verdict.rms_over_postures_m);
  document.world_box_rms_mm = finite_mm(verdict.rms_in_world_m);
  document.rms_mm = finite(mm_from_metres(verdict.rms_m));
  document.chi_square = finite(verdict.chi_square);
  document.degrees_of_freedom = finite(verdict.degrees_of_freedom);
  document.p = finite(verdict.p);
  for (std::size_t i = 0; i < touches.size(); ++i)
    document.touches.push_back(
        {.touch = static_cast<int>(i) + 1,
         .plane = touches[i].face + 1,
         .distance_mm = finite(mm_from_metres(verdict.distances_m[static_cast<Eigen::Index>(i)]))});
}

calib::ToolLimits limits_of(const Cell& cell, const std::string& tool) {
  calib::ToolLimits limits;
  const auto& by_tool = cell.acceptance.tool_box_rms_max_m;
  if (const auto limit = by_tool.find(tool); limit != by_tool.end()) limits.rms_max_m = limit->second;
  return limits;
}

}  // namespace

VerificationResult tool_result(const TipRegions& regions, const Run& run,
                               const VerificationContext& context) {
  const Verification& against = *run.verification();
  const Cell& cell = regions.cell();
  const calib::ToolLimits limits = limits_of(cell, against.tool);
  ToolDocument document{.arm = cell.arm.name,
                        .tool = against.tool,
                        .of_run = std::to_string(against.of_run.value()),
                        .touch_count = run.touches_done(),
                        .complete = context.complete,
                        .drawn_mm = in_mm(against.tip.drawn_m),
                        .box_rms_max_mm = finite_mm(limits.rms_max_m),
                        .p_min = finite(limits.p_min)};
  if (!context.conditions.empty()) document.conditions = CarriedJson{context.conditions};
  const std::vector<calib::Touch> touches = verifying_touches(run.touches());
  const auto postures = calib::postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box,
                                               cell.tools.at(against.tool));
  const auto outcome = calib::find_tool_centre(*against.record, against.tip, touches, postures, limits);
  if (const auto* refusal = std::get_if<calib::ToolRefusal>(&outcome)) {
    document.verdict.reasons = {refusal->message};
  } else {
    tell_tool(std::get<calib::ToolVerdict>(outcome), against.tip, touches, document);
  }
  return {document_text(document), verdict_of(document.verdict)};
}

}  // namespace cell
