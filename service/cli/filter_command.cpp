#include <spdlog/fmt/fmt.h>

#include <stdexcept>

#include "config/file_bytes.hpp"
#include "config/read_config.hpp"
#include "service/cli/applied_arm.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/offline_programs/calibrated_corrector.hpp"
#include "service/offline_programs/filter_records.hpp"
#include "service/offline_programs/filter_text.hpp"
#include "service/offline_programs/filtered_files.hpp"
#include "service/offline_programs/program_folder.hpp"
#include "service/run/compensated_targets.hpp"

namespace cell {
namespace {

/// The cell's tools on the arm, by name, the stylus among them.
CalibratedArm calibrated_arm_of(const Cell& cell, const Arm& arm, const std::string& arm_source) {
  CalibratedArm calibrated{
      .problem = {.nominal = cell.arm.model, .calibrated = arm.model, .joint_ranges = cell.arm.joint_ranges},
      .reference_joints = cell.park_joints};
  const auto add = [&](const std::string& name) {
    calibrated.tools.emplace(name, tool_named(cell, arm, name, arm_source, ""));
  };
  add(std::string(kStylusTool));
  for (const auto& [name, unused] : cell.tools) add(name);
  // As the documents say it.
  calibrated.reason_of = [&cell](const calib::CompensatedTarget& result) {
    return compensation_of(cell, {Target{}}, {result}, "").targets.at(0).reason.value_or("");
  };
  return calibrated;
}

std::vector<std::string> names_of(const CalibratedArm& arm) {
  std::vector<std::string> names;
  for (const auto& [name, unused] : arm.tools) names.push_back(name);
  return names;
}

}  // namespace

ExitCode filter_command(const FilterArguments& arguments, const AppliedArm& applied) {
  const FilteredFiles files{arguments.data_file, arguments.list_file, arguments.file, arguments.overwrite};
  demand_free_output(files);
  const Cell cell = read_cell(arguments.cell_file);
  demand_revolute(cell);
  const Arm& arm = applied.arm;
  demand_arm_of(cell, arm, applied.source);
  demand_serial_of(cell, applied);
  print_warnings(remarks_on(cell, applied));
  const std::string list_text = read_file_bytes(arguments.list_file, kFilterListBytesMax);
  FilterList list = parse_filter_list(arguments.list_file.string(), list_text);
  add_filter_records(arguments.data_file, list);
  CalibratedArm calibrated = calibrated_arm_of(cell, arm, applied.source);
  for (const TouchedTool& touched : applied.touched) {
    demand_tool_of(cell, touched);
    calib::CompensationTool& tool = calibrated.tools.at(touched.tool);
    tool = as_touched(tool, touched);
    fmt::print("tool {}: its tip as touched: {}\n", touched.tool, touched.from);
    calibrated.arms_by_tool.emplace(touched.tool, with_tool(arm.model, touched));
  }
  demand_tools(list, names_of(calibrated));
  std::string data = read_file_bytes(arguments.data_file, kVal3FileBytesMax);
  const ProgramFolder folder = read_program_folder(arguments.data_file);
  FilteredData filtered = filter_data(arguments.data_file.string(), std::move(data), list,
                                      calibrated_corrector(calibrated), folder.mm_per_unit);
  filtered.notes.insert(filtered.notes.end(), folder.notes.begin(), folder.notes.end());
  if (is_uncalibrated(cell, arm)) {
    print_warnings({applied.source + " is as the cell's own arm, no point is changed; give one that was "
                                     "calibrated and exported"});
  }
  write_filtered(files, list_text, filtered);
  fmt::print("{}", filter_text(filtered, program_warnings(folder.programs, filtered, folder.mm_per_unit)));
  return filtered.count(CorrectionStatus::kRefused) == 0 ? kExitDone : kExitLimitsMissed;
}

}  // namespace cell
