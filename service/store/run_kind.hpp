#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace cell {

/// What a run is for. Only the touches of a calibration are fitted. A proof, a check and the touches of a
/// tool are of a calibration before, which they name; a qualification is of one where there is one.
enum class RunKind {
  kCalibration,    // the errors of the arm
  kProof,          // whether the calibrated arm is right where it was not calibrated
  kCheck,          // whether the cell is still as it was
  kQualification,  // what the probe is like
  kTool,           // where the tip of a tool is on the calibrated arm
};
inline constexpr std::array kRunKinds{RunKind::kCalibration, RunKind::kProof, RunKind::kCheck,
                                      RunKind::kQualification, RunKind::kTool};
std::string_view run_kind_name(RunKind kind);  // "calibration"
/// Nothing for a text that names no kind.
std::optional<RunKind> run_kind_named(std::string_view name);

}  // namespace cell
