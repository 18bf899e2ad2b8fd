#include "service/store/run_kind.hpp"

namespace cell {

std::string_view run_kind_name(RunKind kind) {
  switch (kind) {
    case RunKind::kCalibration:
      return "calibration";
    case RunKind::kProof:
      return "proof";
    case RunKind::kCheck:
      return "check";
    case RunKind::kQualification:
      return "qualification";
    case RunKind::kTool:
      return "tool";
  }
  return "";
}

std::optional<RunKind> run_kind_named(std::string_view name) {
  for (const RunKind kind : kRunKinds)
    if (run_kind_name(kind) == name) return kind;
  return std::nullopt;
}

}  // namespace cell
