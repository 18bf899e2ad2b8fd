#include <spdlog/fmt/fmt.h>

#include <optional>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "config/read_config.hpp"
#include "service/cli/applied_arm.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/compensation_text.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/run/compensated_targets.hpp"
#include "service/run/straight_line_targets.hpp"

namespace cell {
namespace {

bool is_csv(const std::filesystem::path& file) { return file.extension() == ".csv"; }

TargetsFile given_targets(const CompensateArguments& arguments) {
  TargetsFile file = read_targets(arguments.targets_file);
  if (arguments.line_max_mm && !file.may_have_lines()) {
    throw std::invalid_argument("--line-max: " + arguments.targets_file.string() +
                                " has no straight lines; leave --line-max out or give targets of schema " +
                                std::string(kTargetsSchema));
  }
  if (arguments.tool.empty()) return file;
  if (file.names_tool) {
    throw std::invalid_argument("--tool: " + arguments.targets_file.string() +
                                " names its tool itself; leave --tool out or give a CSV");
  }
  file.tool = arguments.tool;
  return file;
}

CompensationDocument corrected_document(const CompensateArguments& arguments, const Cell& cell,
                                        const AppliedArm& applied, const TargetsFile& file) {
  const std::string source = arguments.targets_file.string();
  Arm arm = applied.arm;
  calib::CompensationTool tool = file.names_tool ? tool_named(cell, arm, file.tool, source, "/tool")
                                                 : tool_named(cell, arm, file.tool, "--tool", "");
  if (const TouchedTool* touched = applied.touched_as(file.tool)) {
    tool = as_touched(tool, *touched);
    arm.model = with_tool(arm.model, *touched);
  }
  if (!file.may_have_lines()) {
    return compensation_of(cell, file.targets, compensated(cell, arm, tool, file.targets), applied.hash,
                           applied.warmth);
  }
  std::optional<double> given;
  if (arguments.line_max_mm) given = calib::metres_from_mm(*arguments.line_max_mm);
  return compensation_of(cell, compensated_path(cell, arm, tool, file, line_max_m(file, given), source),
                         applied.hash, applied.warmth);
}

}  // namespace

ExitCode compensate_command(const CompensateArguments& arguments, const AppliedArm& applied, bool json) {
  if (arguments.file == "-")
    throw std::invalid_argument("--out: standard output has the targets with --json; name a file");
  std::error_code is_none;
  if (std::filesystem::equivalent(arguments.file, arguments.targets_file, is_none) && !is_none)
    throw std::invalid_argument("--out: " + arguments.file +
                                " is the file of the targets, which is never written; choose another name");
  const Cell cell = read_cell(arguments.cell_file);
  demand_revolute(cell);
  const Arm& arm = applied.arm;
  demand_arm_of(cell, arm, applied.source);
  demand_serial_of(cell, applied);
  if (!applied.remark.empty()) print_warnings({applied.remark});
  const TargetsFile file = given_targets(arguments);
  for (const TouchedTool& touched : applied.touched) {
    demand_tool_of(cell, touched);
    if (touched.tool != file.tool)
      throw std::invalid_argument(fmt::format("{} is of the tool {}, and the targets are of {}; leave it out",
                                              touched.from, touched.tool, file.tool));
  }
  CompensationDocument document = corrected_document(arguments, cell, applied, file);
  if (const TouchedTool* touched = applied.touched_as(file.tool)) document.touched = told_of(*touched);
  if (is_uncalibrated(cell, arm)) {
    print_warnings({applied.source + " is as the cell's own arm, no target is changed; give one that was "
                                     "calibrated and exported"});
  }
  if (!arguments.file.empty()) {
    write_whole_file(arguments.file,
                     is_csv(arguments.file) ? compensated_csv(document) : document_text(document) + "\n",
                     arguments.overwrite);
  }
  fmt::print("{}", json ? document_text(document) + "\n" : compensation_text(document, file.tool));
  return document.count(calib::CompensationStatus::kRefused) == 0 ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
