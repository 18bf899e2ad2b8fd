#include "cs8_protocol/names.hpp"

// No `default` in these switches: the compiler then names the value that was forgotten here.
namespace cs8 {

std::string_view name(MessageType type) {
  switch (type) {
    case MessageType::kHello:
      return "hello";
    case MessageType::kHeartbeat:
      return "heartbeat";
    case MessageType::kTouch:
      return "touch";
    case MessageType::kTravel:
      return "travel";
    case MessageType::kRetract:
      return "retract";
    case MessageType::kStop:
      return "stop";
    case MessageType::kResultQuery:
      return "result_query";
    case MessageType::kResultAcknowledge:
      return "result_acknowledge";
    case MessageType::kBegin:
      return "begin";
    case MessageType::kFinish:
      return "finish";
    case MessageType::kWelcome:
      return "welcome";
    case MessageType::kState:
      return "state";
    case MessageType::kAccepted:
      return "accepted";
    case MessageType::kRejected:
      return "rejected";
    case MessageType::kTouchResult:
      return "touch_result";
    case MessageType::kMoveResult:
      return "move_result";
    case MessageType::kResultUnknown:
      return "result_unknown";
    case MessageType::kFault:
      return "fault";
    case MessageType::kPermit:
      return "permit";
  }
  return {};
}

std::string_view name(RejectReason reason) {
  switch (reason) {
    case RejectReason::kBusy:
      return "busy";
    case RejectReason::kResultUnacknowledged:
      return "result_unacknowledged";
    case RejectReason::kStaleSequence:
      return "stale_sequence";
    case RejectReason::kNotRemote:
      return "not_remote";
    case RejectReason::kNotPowered:
      return "not_powered";
    case RejectReason::kHold:
      return "hold";
    case RejectReason::kEmergencyStop:
      return "emergency_stop";
    case RejectReason::kNotCalibrated:
      return "not_calibrated";
    case RejectReason::kOutOfRange:
      return "out_of_range";
    case RejectReason::kProbeTriggered:
      return "probe_triggered";
    case RejectReason::kMonitorSpeed:
      return "monitor_speed";
    case RejectReason::kSearchTooLong:
      return "search_too_long";
    case RejectReason::kSearchTooFast:
      return "search_too_fast";
    case RejectReason::kBadField:
      return "bad_field";
    case RejectReason::kNothingToRetract:
      return "nothing_to_retract";
    case RejectReason::kRetractPending:
      return "retract_pending";
    case RejectReason::kNotPermitted:
      return "not_permitted";
    case RejectReason::kProbeInputs:
      return "probe_inputs";
    case RejectReason::kCellOpen:
      return "cell_open";
    case RejectReason::kTouchTestMissing:
      return "touch_test_missing";
    case RejectReason::kTaskFailed:
      return "task_failed";
  }
  return {};
}

std::string_view name(Outcome outcome) {
  switch (outcome) {
    case Outcome::kContact:
      return "contact";
    case Outcome::kNoContact:
      return "no_contact";
    case Outcome::kArrived:
      return "arrived";
    case Outcome::kUnexpectedContact:
      return "unexpected_contact";
    case Outcome::kProbeStuck:
      return "probe_stuck";
    case Outcome::kStopped:
      return "stopped";
    case Outcome::kHeartbeatLost:
      return "heartbeat_lost";
    case Outcome::kPermissionLost:
      return "permission_lost";
    case Outcome::kCollision:
      return "collision";
    case Outcome::kMotionError:
      return "motion_error";
    case Outcome::kDeadline:
      return "deadline";
    case Outcome::kOvertravel:
      return "overtravel";
    case Outcome::kProbeFault:
      return "probe_fault";
    case Outcome::kTaskFailed:
      return "task_failed";
  }
  return {};
}

std::string_view name(Phase phase) {
  switch (phase) {
    case Phase::kIdle:
      return "idle";
    case Phase::kTravel:
      return "travel";
    case Phase::kApproach:
      return "approach";
    case Phase::kSearch:
      return "search";
    case Phase::kRetract:
      return "retract";
  }
  return {};
}

std::string_view name(CaptureSource source) {
  switch (source) {
    case CaptureSource::kNone:
      return "none";
    case CaptureSource::kLatched:
      return "latched";
    case CaptureSource::kPolled:
      return "polled";
  }
  return {};
}

std::string_view name(WorkingMode mode) {
  switch (mode) {
    case WorkingMode::kNone:
      return "none";
    case WorkingMode::kManual:
      return "manual";
    case WorkingMode::kTest:
      return "test";
    case WorkingMode::kLocal:
      return "local";
    case WorkingMode::kRemote:
      return "remote";
  }
  return {};
}

std::string_view name(FaultCode code) {
  switch (code) {
    case FaultCode::kBadMagic:
      return "bad_magic";
    case FaultCode::kVersion:
      return "version";
    case FaultCode::kUnknownType:
      return "unknown_type";
    case FaultCode::kLength:
      return "length";
    case FaultCode::kNoHandshake:
      return "no_handshake";
    case FaultCode::kOccupied:
      return "occupied";
    case FaultCode::kWrongSide:
      return "wrong_side";
    case FaultCode::kBadValue:
      return "bad_value";
    case FaultCode::kStopping:
      return "stopping";
  }
  return {};
}

std::string_view name(PermitState state) {
  switch (state) {
    case PermitState::kNone:
      return "none";
    case PermitState::kAwaited:
      return "awaited";
    case PermitState::kGranted:
      return "granted";
    case PermitState::kRetractOnly:
      return "retract_only";
  }
  return {};
}

std::string_view name(PermitReason reason) {
  switch (reason) {
    case PermitReason::kNone:
      return "none";
    case PermitReason::kRefused:
      return "refused";
    case PermitReason::kNotConfirmed:
      return "not_confirmed";
    case PermitReason::kFinished:
      return "finished";
    case PermitReason::kBrokenOff:
      return "broken_off";
    case PermitReason::kPermissionLost:
      return "permission_lost";
    case PermitReason::kProbeFault:
      return "probe_fault";
  }
  return {};
}

}  // namespace cs8
