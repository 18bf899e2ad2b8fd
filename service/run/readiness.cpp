#include "service/run/readiness.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace cell {
namespace {

using cs8::RejectReason;

struct Remedy {
  RejectReason refusal;
  FaultCode precondition;  // of a start, that is not met for the same reason
  AwaitedAction awaited;
};

constexpr std::array kRemedies{
    Remedy{RejectReason::kTouchTestMissing,
           FaultCode::kTouchTestMissing,
           {"touch_test", "touch the stylus by hand, in manual mode or with power off"}},
    Remedy{RejectReason::kCellOpen, FaultCode::kCellOpen, {"cell_closed", "leave and close the cell"}},
    Remedy{RejectReason::kNotRemote,
           FaultCode::kNotRemote,
           {"remote_mode", "turn the controller to remote mode"}},
    Remedy{RejectReason::kNotPowered, FaultCode::kNotPowered, {"power", "switch the arm's power on"}},
    Remedy{RejectReason::kHold, FaultCode::kHold, {"hold_released", "release the hold on the pendant"}},
    Remedy{RejectReason::kEmergencyStop,
           FaultCode::kEmergencyStop,
           {"emergency_stop_released", "release and acknowledge the emergency stop"}},
    Remedy{RejectReason::kNotCalibrated,
           FaultCode::kNotCalibrated,
           {"arm_referenced", "let the controller find its joint references"}},
    Remedy{RejectReason::kMonitorSpeed,
           FaultCode::kMonitorSpeed,
           {"monitor_speed", "set the monitor speed to 100 %"}},
    Remedy{
        RejectReason::kProbeTriggered,
        FaultCode::kProbeTouched,
        {"probe_free",
         "free the probe: it reads touched; where its stylus rests on a face, jog the arm off it in manual "
         "mode"}},
    Remedy{RejectReason::kProbeInputs,
           FaultCode::kProbeFault,
           {"probe_inputs", "check the probe's cable: its two inputs disagree"}},
};

constexpr AwaitedAction kConfirmation{"confirmation", "press the confirmation key at the cell"};

const AwaitedAction& remedy_of(RejectReason refusal) {
  return std::ranges::find(kRemedies, refusal, &Remedy::refusal)->awaited;
}

}  // namespace

const AwaitedAction* awaited_after_rejection(RejectReason refusal, std::uint32_t flags) {
  if (std::ranges::find(kRemedies, refusal, &Remedy::refusal) == kRemedies.end()) return nullptr;
  const bool tested = (flags & cs8::kTouchTested) != 0;
  if (tested || refusal == RejectReason::kProbeInputs) return &remedy_of(refusal);
  constexpr std::uint32_t kAtFace = cs8::kRetractDue | cs8::kProbeTouched;
  return &remedy_of((flags & kAtFace) == kAtFace ? RejectReason::kProbeTriggered
                                                 : RejectReason::kTouchTestMissing);
}

const AwaitedAction* awaited_by_precondition(std::string_view name) {
  const auto found = std::ranges::find_if(
      kRemedies, [name](const Remedy& remedy) { return describe(remedy.precondition).name == name; });
  return found == kRemedies.end() ? nullptr : &found->awaited;
}

const AwaitedAction& awaited_confirmation() { return kConfirmation; }

const AwaitedAction& awaited_touch_test() { return remedy_of(RejectReason::kTouchTestMissing); }

std::string_view awaited_instruction(std::string_view name) {
  if (name == kConfirmation.name) return kConfirmation.words;
  const auto found =
      std::ranges::find_if(kRemedies, [name](const Remedy& remedy) { return remedy.awaited.name == name; });
  return found == kRemedies.end() ? name : found->awaited.words;
}

Fault not_ready_fault(const AwaitedAction& awaited) {
  if (awaited.name == kConfirmation.name) return {FaultCode::kNotConfirmed, {}};
  if (&awaited == &remedy_of(RejectReason::kTouchTestMissing)) return {FaultCode::kTouchTestMissing, {}};
  if (&awaited == &remedy_of(RejectReason::kCellOpen)) return {FaultCode::kCellOpen, {}};
  if (&awaited == &remedy_of(RejectReason::kProbeInputs)) return {FaultCode::kProbeFault, {}};
  return {FaultCode::kNotReady, std::string(awaited.words)};
}

Readiness readiness_of(const cs8::State& state) {
  constexpr std::uint32_t kOfMotion = cs8::kSettled | cs8::kQueueEmpty | cs8::kRetractDue;
  return {.flags = state.flags & ~kOfMotion,
          .mode = state.mode,
          .emergency_stop = state.emergency_stop,
          .monitor_speed_percent = state.monitor_speed_percent};
}

}  // namespace cell
