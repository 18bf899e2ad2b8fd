#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <vector>

#include "calib_core/geometry/units.hpp"
#include "config/read_config.hpp"
#include "service/base/utc_time.hpp"
#include "service/cli/applied_arm.hpp"
#include "service/cli/commands.hpp"
#include "service/cli/offline.hpp"
#include "service/documents/compensation_view.hpp"
#include "service/exports/correction_library.hpp"
#include "service/run/compensated_targets.hpp"

namespace cell {
namespace {

/// A controller's clock shows its zone's time: the day there may be another one.
constexpr std::chrono::hours kZonesApart{24};

/// The day of an RFC 3339 time, 20270131 of 2027-01-31T...; 0 of none.
int day_of(const std::optional<std::string>& time) {
  if (!time) return 0;
  return std::stoi(time->substr(0, 4) + time->substr(5, 2) + time->substr(8, 2));
}

std::string warmth_of(const AppliedArm& applied) {
  if (!applied.warmth) return "as warm as at the calibration";
  constexpr double kPpm = 1e6;
  return fmt::format("grown by {:.0f} ppm, check {} of {}", applied.warmth->growth * kPpm,
                     applied.warmth->check_run_id, applied.warmth->at.substr(0, 10));
}

std::vector<std::string> library_remarks(const Cell& cell, const AppliedArm& applied) {
  std::vector<std::string> remarks = remarks_on(cell, applied);
  if (!applied.valid_until)
    remarks.push_back(
        "these numbers count on the controller without an end, and nothing there knows of a newer model: "
        "write "
        "them anew with each; touchcal approve --valid-days sets an end");
  return remarks;
}

}  // namespace

ExitCode library_command(const LibraryArguments& arguments, const CompensateArguments& beside,
                         const AppliedArm& applied, std::chrono::system_clock::time_point now) {
  demand_writable({arguments.file}, beside.overwrite);
  const Cell cell = read_cell(beside.cell_file);
  demand_revolute(cell);
  demand_arm_of(cell, applied.arm, applied.source);
  demand_serial_of(cell, applied);
  if (!applied.touched.empty())
    throw std::invalid_argument(fmt::format(
        "{} is of the tool {}, and the library takes the tool that a program hands it: leave it out, and put "
        "the touched centre into the controller's tool",
        applied.touched.front().from, applied.touched.front().tool));
  if (!applied.serial)
    throw std::invalid_argument(applied.source +
                                " does not say of which robot it is, and the library would correct on any; "
                                "put arm_serial into the cell's "
                                "file, as getVersion(\"ArmSN\") of the controller gives it, and calibrate");
  if (is_uncalibrated(cell, applied.arm))
    throw std::invalid_argument(applied.source +
                                " is as the cell's own arm, no point would be changed; give one that was "
                                "calibrated and exported");
  print_warnings(library_remarks(cell, applied));
  const CorrectionLibrary library{.arms = {.nominal = cell.arm.model,
                                           .calibrated = applied.arm.model,
                                           .joint_ranges = cell.arm.joint_ranges,
                                           .covariance = {}},
                                  .wrist_to_flange_m = calib::metres_from_mm(arguments.flange_mm),
                                  .serial = *applied.serial,
                                  .model = applied.hash,
                                  .warmth = warmth_of(applied),
                                  .from = day_of(format_utc(now - kZonesApart)),
                                  .valid_until = day_of(applied.valid_until)};
  write_whole_file(arguments.file, correction_library_data(library), beside.overwrite);
  if (arguments.file == "-") return kExitDone;
  fmt::print("{}: the numbers of touchcal_abs for the arm {}, {}\n", arguments.file, library.serial,
             applied.source);
  fmt::print(
      "  model {}, {}, {}\n", library.model, library.warmth,
      library.valid_until == 0 ? "without an end" : "valid until " + applied.valid_until->substr(0, 10));
  fmt::print(
      "  copy the folder touchcal_abs to the controller with this file in it: INSTALL.md, section 14\n");
  return kExitDone;
}

}  // namespace cell
