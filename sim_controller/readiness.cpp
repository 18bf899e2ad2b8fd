#include "sim_controller/readiness.hpp"

#include "sim_controller/controller_state.hpp"

namespace sim {

using cs8::PermitState;
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

namespace {

/// A command or a run cannot begin before the one before is done with.
std::optional<RejectReason> refusal_of_another(const ControllerState& state) {
  if (state.motion.running) return RejectReason::kBusy;
  if (state.stored_result) return RejectReason::kResultUnacknowledged;
  return std::nullopt;
}

}  // namespace

std::optional<RejectReason> refusal_of_begin(const ControllerState& state) {
  if (state.cabinet.task_error != 0) return RejectReason::kTaskFailed;
  if (const auto reason = refusal_of_another(state)) return reason;
  if (const auto rejected = cabinet_refusal(state.cabinet)) return rejected->reason;
  // Behind a touch that was broken off the stylus may be bent: the way back is all that moves first.
  if (state.motion.retract_path.empty()) {
    if (const auto rejected = probe_refusal(state.cabinet)) return rejected->reason;
  } else if (state.cabinet.probe_disagrees()) {
    return RejectReason::kProbeInputs;
  }
  if (state.cabinet.touch_test != TouchTest::kDone) return RejectReason::kTouchTestMissing;
  return std::nullopt;
}

std::optional<cs8::Rejected> refusal_of_motion(const ControllerState& state, std::uint32_t sequence,
                                               bool is_retract) {
  const auto because = [](RejectReason reason, std::int32_t detail = 0) {
    return cs8::Rejected{reason, detail};
  };
  if (sequence <= state.last_sequence) return because(RejectReason::kStaleSequence);
  if (const auto reason = refusal_of_another(state)) return because(*reason);
  if (auto rejected = cabinet_refusal(state.cabinet)) return rejected;
  const PermitState permit = state.permit.permit.state;
  if (permit != PermitState::kGranted && !(is_retract && permit == PermitState::kRetractOnly)) {
    return because(RejectReason::kNotPermitted, static_cast<std::int32_t>(permit));
  }
  const bool near_a_face = !state.motion.retract_path.empty();
  if (near_a_face && !is_retract) return because(RejectReason::kRetractPending);
  if (!near_a_face && is_retract) return because(RejectReason::kNothingToRetract);
  return std::nullopt;
}

}  // namespace sim
