#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/config_error.hpp"
#include "config/read_config.hpp"
#include "service/cli/applied_arm.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/compensation_text.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/exports/robodk_list.hpp"
#include "service/offline_programs/trsf_pose.hpp"
#include "service/run/compensated_targets.hpp"
#include "service/run/straight_line_targets.hpp"

namespace cell {
namespace {

/// Poses of a list in the controller's world, which it took them for.
void place_in(const std::string& frame, const TargetFrames& frames, TargetsFile& file) {
  if (const std::string why = why_no_target_frame(frames, frame); !why.empty())
    throw ConfigError("--frame", "", why);
  const Eigen::Isometry3d world_from_frame = world_from_target_frame(frames, frame);
  for (Target& target : file.targets)
    if (auto* pose = std::get_if<PoseTarget>(&target.wanted))
      pose->world_from_tool = world_from_frame * pose->world_from_tool;
}

TargetsFile given_targets(const CompensateArguments& arguments, const TargetFrames& frames) {
  TargetsFile file = read_targets(arguments.targets_file, frames);
  const std::string source = arguments.targets_file.string();
  if (arguments.line_max_mm && !file.may_have_lines()) {
    throw std::invalid_argument("--line-max: " + source +
                                " has no straight lines; leave --line-max out or give targets of schema " +
                                std::string(kTargetsSchema));
  }
  if (!arguments.frame.empty()) {
    if (!file.leaves_frame_open)
      throw std::invalid_argument(
          "--frame: " + source +
          (file.names_tool ? " names the frame of each pose itself" : " has joints and no poses") +
          "; leave --frame out or give a RoboDK list");
    place_in(arguments.frame, frames, file);
  }
  if (arguments.tool.empty()) return file;
  if (file.names_tool) {
    throw std::invalid_argument("--tool: " + source +
                                " names its tool itself; leave --tool out or give a CSV");
  }
  file.tool = arguments.tool;
  return file;
}

/// What the targets are corrected with.
struct AppliedTool {
  Arm arm;
  calib::CompensationTool tool = {};
};

AppliedTool applied_tool(const Cell& cell, const AppliedArm& applied, const TargetsFile& file,
                         const std::string& source) {
  AppliedTool with{.arm = applied.arm};
  with.tool = file.names_tool ? tool_named(cell, with.arm, file.tool, source, "/tool")
                              : tool_named(cell, with.arm, file.tool, "--tool", "");
  if (const TouchedTool* touched = applied.touched_as(file.tool)) {
    with.tool = as_touched(with.tool, *touched);
    with.arm.model = with_tool(with.arm.model, *touched);
  }
  return with;
}

CompensationDocument corrected_document(const CompensateArguments& arguments, const Cell& cell,
                                        const AppliedArm& applied, const AppliedTool& with,
                                        const TargetsFile& file) {
  if (!file.may_have_lines()) {
    const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    return compensation_of(cell, file.targets, compensated(cell, with.arm, with.tool, file.targets, threads),
                           applied.hash, applied.warmth);
  }
  std::optional<double> given;
  if (arguments.line_max_mm) given = calib::metres_from_mm(*arguments.line_max_mm);
  return compensation_of(cell,
                         compensated_path(cell, with.arm, with.tool, file, line_max_m(file, given),
                                          arguments.targets_file.string()),
                         applied.hash, applied.warmth);
}

/// With the poses that the controller has to be given; a refused target is a remark.
std::string list_of_poses(const CompensationDocument& document, const Cell& cell, const AppliedTool& with,
                          const std::string& tool) {
  const calib::Compensation compensation = compensation_in(cell, with.arm);
  std::vector<std::string> remarks{fmt::format("{} for the calibrated arm {}: targets of cell {}, tool {}",
                                               kCorrectedRemark, document.model, cell.name, tool)};
  std::vector<ListedPose> poses;
  for (const CompensationDocument::Target& target : document.targets) {
    if (!target.joints_deg) {
      remarks.push_back(fmt::format("refused and left out: {}: {}", target.name, target.reason.value_or("")));
      continue;
    }
    const calib::JointVector joints =
        Eigen::Map<const calib::JointVector>(target.joints_deg->data()) * calib::kRadiansPerDegree;
    poses.push_back(
        {.name = target.name,
         .world_from_tool = trsf_of_pose(compensation.nominal_world_from_tool(with.tool, joints), {}, 1.0),
         .joints_deg = *target.joints_deg});
  }
  return robodk_list(poses, remarks);
}

/// What is asked for by --format, else by the name of the file.
std::string form_of(const CompensateArguments& arguments) {
  if (!arguments.format.empty()) return arguments.format;
  return std::filesystem::path(arguments.file).extension() == ".csv" ? "csv" : "json";
}

}  // namespace

ExitCode compensate_command(const CompensateArguments& arguments, const AppliedArm& applied, bool json) {
  if (arguments.file.empty() && !arguments.format.empty())
    throw std::invalid_argument("--format: is the form of --out; name a file with --out");
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
  print_warnings(remarks_on(cell, applied));
  const TargetsFile file = given_targets(arguments, cell.target_frames);
  for (const TouchedTool& touched : applied.touched) {
    demand_tool_of(cell, touched);
    if (touched.tool != file.tool)
      throw std::invalid_argument(fmt::format("{} is of the tool {}, and the targets are of {}; leave it out",
                                              touched.from, touched.tool, file.tool));
  }
  const AppliedTool with = applied_tool(cell, applied, file, arguments.targets_file.string());
  CompensationDocument document = corrected_document(arguments, cell, applied, with, file);
  if (const TouchedTool* touched = applied.touched_as(file.tool)) document.touched = told_of(*touched);
  if (is_uncalibrated(cell, arm)) {
    print_warnings({applied.source + " is as the cell's own arm, no target is changed; give one that was "
                                     "calibrated and exported"});
  }
  const std::string form = form_of(arguments);
  std::string whole;
  if (json || form == "json") {
    whole = document_text(document);
    whole += '\n';
  }
  if (!arguments.file.empty()) {
    write_whole_file(arguments.file,
                     form == "robodk" ? list_of_poses(document, cell, with, file.tool)
                     : form == "csv"  ? compensated_csv(document)
                                      : whole,
                     arguments.overwrite);
  }
  if (json)
    print_whole(whole);
  else
    print_whole(compensation_text(document, file.tool));
  return document.count(calib::CompensationStatus::kRefused) == 0 ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
