#include "sim_controller/readiness.hpp"

namespace sim {

using cs8::RejectReason;

std::optional<cs8::Rejected> cabinet_refusal(const Cabinet& cabinet) {
  const auto because = [](RejectReason reason, std::int32_t detail = 0) {
    return cs8::Rejected{reason, detail};
  };
  const Panel& panel = cabinet.panel;
  if (cabinet.task_error != 0) return because(RejectReason::kTaskFailed, cabinet.task_error);
  if (panel.emergency_stop != 0) return because(RejectReason::kEmergencyStop);
  if (panel.mode != cs8::WorkingMode::kRemote) return because(RejectReason::kNotRemote);
  if (!panel.powered) return because(RejectReason::kNotPowered);
  if (panel.held) return because(RejectReason::kHold);
  if (!panel.arm_calibrated) return because(RejectReason::kNotCalibrated);
  if (panel.monitor_speed_percent != 100) {
    return because(RejectReason::kMonitorSpeed, panel.monitor_speed_percent);
  }
  if (!panel.cell_closed) return because(RejectReason::kCellOpen);
  return std::nullopt;
}

std::optional<cs8::Rejected> probe_refusal(const Cabinet& cabinet) {
  const ProbeInputs& inputs = cabinet.world.probe.inputs;
  if (!inputs.agree()) {
    const int bits = (inputs.contact ? 1 : 0) + (inputs.loop ? 2 : 0);
    return cs8::Rejected{RejectReason::kProbeInputs, bits};
  }
  if (!cabinet.probe_free()) return cs8::Rejected{RejectReason::kProbeTriggered, 0};
  return std::nullopt;
}

}  // namespace sim
