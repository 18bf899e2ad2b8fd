#pragma once

#include <cstdint>

/// The numbers of the protocol: types, reasons, outcomes, states, flags. PROTOCOL.md says for each what it
/// means, what causes it and what to do; names.hpp has its name.
namespace cs8 {

enum class MessageType : std::uint8_t {
  // host -> controller
  kHello = 1,
  kHeartbeat = 2,
  kTouch = 3,
  kTravel = 4,
  kRetract = 5,
  kStop = 6,
  kResultQuery = 7,
  kResultAcknowledge = 8,
  kBegin = 9,
  kFinish = 10,
  // controller -> host
  kWelcome = 65,
  kState = 66,
  kAccepted = 67,
  kRejected = 68,
  kTouchResult = 69,
  kMoveResult = 70,
  kResultUnknown = 71,
  kFault = 72,
  kPermit = 73,
};

/// Why a command was refused before anything moved.
enum class RejectReason : std::int32_t {
  kBusy = 1,                  // another motion command is running
  kResultUnacknowledged = 2,  // the result of the previous command was not acknowledged yet
  kStaleSequence = 3,         // not newer than the newest command taken, and no longer stored
  kNotRemote = 4,
  kNotPowered = 5,
  kHold = 6,
  kEmergencyStop = 7,
  kNotCalibrated = 8,
  kOutOfRange = 9,       // a posture outside the joint ranges; `detail` is the joint, from 1
  kProbeTriggered = 10,  // the probe reads touched before any motion
  kMonitorSpeed = 11,    // not 100 %; `detail` is the monitor speed
  kSearchTooLong = 12,   // `detail` is the limit, 10^-4 mm
  kSearchTooFast = 13,   // the arm could not stop within half the overtravel; `detail` is the limit, um/s
  kBadField = 14,        // a speed or deadline that makes no sense; `detail` is the payload word, from 1
  kNothingToRetract = 15,
  kRetractPending = 16,  // StateFlag::kRetractDue is set: only a retract is allowed
  kNotPermitted = 17,  // the run was not confirmed at the cell, or the permit is lost; `detail` is the Permit
  kProbeInputs = 18,   // the two probe inputs disagree; `detail` is contact + 2 * loop
  kCellOpen = 19,
  kTouchTestMissing = 20,  // the stylus was not touched by hand since the start or since the cell was open
  kTaskFailed = 21,        // a task of the application ended with a run-time error; `detail` is its number
};

/// How a motion command ended.
enum class Outcome : std::int32_t {
  kContact = 1,            // touch: the probe tripped in the search and was free again after the retract
  kNoContact = 2,          // touch: search end reached, no edge; retracted
  kArrived = 3,            // travel, retract: at the last posture
  kUnexpectedContact = 4,  // an edge in a move that is not a search: stopped there
  kProbeStuck = 5,         // still touched after the retract
  kStopped = 6,            // by kStop; a search was retracted to its approach posture
  kHeartbeatLost = 7,      // the host was silent: stopped, not retracted
  kPermissionLost = 8,     // power, mode, hold or emergency stop
  kCollision = 9,          // following error or crash protection; power is off
  kMotionError = 10,       // error_number says which run-time error (out of reach, singular line, ...)
  kDeadline = 11,          // not done within deadline_ms: stopped
  kOvertravel = 12,        // the arm stopped farther behind the trigger than the stylus may bend
  kProbeFault = 13,        // the two probe inputs disagreed: a cable is cut or shorted
  kTaskFailed = 14,        // a task of the application ended; error_number says with which run-time error
};

/// What the controller is doing in a motion command, and how far it got.
enum class Phase : std::int32_t { kIdle = 0, kTravel = 1, kApproach = 2, kSearch = 3, kRetract = 4 };

/// Where the joints of a contact come from.
enum class CaptureSource : std::int32_t { kNone = 0, kLatched = 1, kPolled = 2 };

/// Whether motion commands are taken: a person at the cell confirms each run.
enum class PermitState : std::int32_t {
  kNone = 0,         // nothing moves
  kAwaited = 1,      // Begin was taken, the confirmation input is watched
  kGranted = 2,      // touch, travel and retract are taken
  kRetractOnly = 3,  // a command was broken off: only Retract is accepted
};

/// Why the permit is what it is.
enum class PermitReason : std::int32_t {
  kNone = 0,            // it was asked for or confirmed
  kRefused = 1,         // Begin was refused; `detail` is the RejectReason
  kNotConfirmed = 2,    // not confirmed in time
  kFinished = 3,        // by Finish
  kBrokenOff = 4,       // a command ended by a stop, an unexpected contact, a deadline or an error
  kPermissionLost = 5,  // mode, power, hold, emergency stop, or the cell was opened
  kProbeFault = 6,      // the probe inputs disagree
};

enum class WorkingMode : std::int32_t { kNone = 0, kManual = 1, kTest = 2, kLocal = 3, kRemote = 4 };

/// Bits of State::flags.
enum StateFlag : std::uint32_t {
  kPowered = 1u << 0,
  kHeld = 1u << 1,           // move/hold key on hold: the queue does not move
  kArmCalibrated = 1u << 2,  // joint positions are referenced
  kSettled = 1u << 3,
  kQueueEmpty = 1u << 4,
  kProbeTouched = 1u << 5,
  kRetractDue = 1u << 6,  // a touch left its clear posture and did not come back to it: only kRetract moves
  kProbeLoopClosed = 1u << 7,  // second probe input: closed while the stylus is free and the cable whole
  kTouchTested = 1u << 8,      // the stylus was touched by hand since the start and since the cell was open
  kCellClosed = 1u << 9,
};

/// Both probe inputs at once. Two wires that say the same thing in opposite ways: a cut or shorted cable
/// is neither free nor touched.
struct ProbeInputs {
  bool contact = false;  // latch input: on when touched
  bool loop = true;      // normally-closed loop: on when free
  [[nodiscard]] constexpr bool free() const { return !contact && loop; }
  [[nodiscard]] constexpr bool touched() const { return contact && !loop; }
  [[nodiscard]] constexpr bool agree() const { return contact != loop; }
  friend constexpr bool operator==(const ProbeInputs&, const ProbeInputs&) = default;
};

/// The inputs as State's flags tell them.
constexpr ProbeInputs probe_inputs(std::uint32_t flags) {
  return {(flags & kProbeTouched) != 0, (flags & kProbeLoopClosed) != 0};
}

/// Why the controller closes the connection.
enum class FaultCode : std::int32_t {
  kBadMagic = 1,
  kVersion = 2,      // `detail` is the controller's protocol version
  kUnknownType = 3,  // `detail` is the type
  kLength = 4,       // payload length is not the type's; `detail` is the expected length
  kNoHandshake = 5,  // a command before kHello
  kOccupied = 6,     // another host is connected; this connection alone is closed
  kWrongSide = 7,    // a message only the controller sends; `detail` is the type
  kBadValue = 8,     // a count outside its range; `detail` is the payload word, from 1
  kStopping = 9,     // the application is being ended at the pendant
};

}  // namespace cs8
