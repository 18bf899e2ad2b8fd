#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

/// Every message between touchcal and the controller, declared once; PROTOCOL.md describes the same in prose.
/// A frame is a header and a payload of fixed size for its type, all little-endian:
///   'T' 'C' | version u8 | type u8 | sequence u32 | payload length u16 | payload
/// Payload fields are 32-bit words (VAL3 reads "-4l" and "4l") but for text, which is bytes padded with NUL.
/// `visit` names the fields in wire order; codec.cpp reads and writes through it, so the two cannot drift.
namespace cs8 {

inline constexpr std::uint8_t kProtocolVersion = 2;
inline constexpr std::size_t kHeaderSize = 10;
inline constexpr std::size_t kPayloadSizeMax = 512;
inline constexpr std::size_t kViaCountMax = 5;

/// Joint positions as the controller has them, 10^-6 degree, joint 1 first.
using JointsMicrodeg = std::array<std::int32_t, 6>;

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
  kNotPermitted = 17,  // nobody at the cell confirmed the run, or the permit is lost; `detail` is the Permit
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
  kRetractOnly = 3,  // a command was broken off: the way back from a face is all that is left
};

/// Why the permit is what it is.
enum class PermitReason : std::int32_t {
  kNone = 0,            // it was asked for or confirmed
  kRefused = 1,         // Begin was refused; `detail` is the RejectReason
  kNotConfirmed = 2,    // nobody confirmed in time
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

// ---- host -> controller ----

/// First message of a connection.
struct Hello {
  static constexpr MessageType kType = MessageType::kHello;
  std::uint32_t heartbeat_timeout_ms{};  // silence after which the controller stops; brought into 200..2000
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.heartbeat_timeout_ms);
  }
};

/// Sent every 100 ms.
struct Heartbeat {
  static constexpr MessageType kType = MessageType::kHeartbeat;
  std::uint32_t host_clock_ms{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.host_clock_ms);
  }
};

/// One guarded touch, carried out whole: joint moves through `via` to `clear`, to `approach`, a straight line
/// to `search_end` until the probe trips, a little back and slowly there again, back to `approach`, back to
/// `clear`. Answered once, by TouchResult.
struct Touch {
  static constexpr MessageType kType = MessageType::kTouch;
  std::int32_t via_count{};  // how many of `via` are used
  std::array<JointsMicrodeg, kViaCountMax> via{};
  JointsMicrodeg clear{};
  JointsMicrodeg approach{};
  JointsMicrodeg search_end{};
  std::int32_t travel_speed_um_s{};    // cap of the tool centre's speed on the way to `clear`
  std::int32_t approach_speed_um_s{};  // clear <-> approach, and the retract
  std::int32_t search_speed_um_s{};
  std::int32_t second_speed_um_s{};   // of the second, slow touch; 0 for none
  std::int32_t second_backoff_dmm{};  // how far back from the first stop it begins, 10^-4 mm
  std::uint32_t deadline_ms{};        // of the whole command
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.via_count, m.via, m.clear, m.approach, m.search_end, m.travel_speed_um_s, m.approach_speed_um_s,
           m.search_speed_um_s, m.second_speed_um_s, m.second_backoff_dmm, m.deadline_ms);
  }
};

/// Joint moves through `via` to `target`, where an edge is an unexpected contact. Answered by MoveResult.
struct Travel {
  static constexpr MessageType kType = MessageType::kTravel;
  std::int32_t via_count{};
  std::array<JointsMicrodeg, kViaCountMax> via{};
  JointsMicrodeg target{};
  std::int32_t travel_speed_um_s{};
  std::uint32_t deadline_ms{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.via_count, m.via, m.target, m.travel_speed_um_s, m.deadline_ms);
  }
};

/// From wherever a touch was broken off, back along the line of its search to its approach posture and on to
/// its clear posture. The only motion allowed while StateFlag::kRetractDue is set.
struct Retract {
  static constexpr MessageType kType = MessageType::kRetract;
  std::int32_t approach_speed_um_s{};
  std::uint32_t deadline_ms{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.approach_speed_um_s, m.deadline_ms);
  }
};

/// Ends the running motion command at once; its result follows with kStopped. Harmless when nothing runs.
struct Stop {
  static constexpr MessageType kType = MessageType::kStop;
  template <class Self, class Fields>
  static constexpr void visit(Self&, Fields&) {}
};

/// What became of the command with this sequence? Answered by its result, by Accepted while it runs, or by
/// ResultUnknown.
struct ResultQuery {
  static constexpr MessageType kType = MessageType::kResultQuery;
  std::uint32_t command_sequence{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.command_sequence);
  }
};

/// The result is stored: the controller may forget it and take the next command.
struct ResultAcknowledge {
  static constexpr MessageType kType = MessageType::kResultAcknowledge;
  std::uint32_t command_sequence{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.command_sequence);
  }
};

/// Asks for a run: the controller waits for a person's confirmation at the cell, `confirm_within_ms` at most.
/// Answered by Permit, at once and at each change. Touch, Travel and Retract are taken with a permit only.
struct Begin {
  static constexpr MessageType kType = MessageType::kBegin;
  std::uint32_t run{};                // the host's number of the run, for the pendant and the logs
  std::uint32_t confirm_within_ms{};  // brought into 1000..30000
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.run, m.confirm_within_ms);
  }
};

/// The run is over: the permit is given back.
struct Finish {
  static constexpr MessageType kType = MessageType::kFinish;
  template <class Self, class Fields>
  static constexpr void visit(Self&, Fields&) {}
};

// ---- controller -> host ----

using Text16 = std::array<char, 16>;  // printable ASCII, padded with NUL

/// The first 16 characters of `text`.
constexpr Text16 text16(std::string_view text) {
  Text16 field{};
  std::copy_n(text.begin(), std::min(text.size(), field.size()), field.begin());
  return field;
}
/// `field` without its padding.
constexpr std::string_view text_of(const Text16& field) {
  return {field.data(),
          static_cast<std::size_t>(std::find(field.begin(), field.end(), '\0') - field.begin())};
}

/// Answer to Hello.
struct Welcome {
  static constexpr MessageType kType = MessageType::kWelcome;
  Text16 application{};                  // "touchcal"
  Text16 arm{};                          // "tx90"
  std::uint32_t application_version{};   // 10000 major + 100 minor + patch
  std::uint32_t language_version{};      // VAL3: 70702 is s7.7.2
  std::uint32_t session{};               // counts starts of the application
  std::uint32_t last_sequence{};         // newest command taken in this session, 0 for none
  std::uint32_t open_sequence{};         // a command that runs or whose result waits, 0 for none
  std::uint32_t heartbeat_timeout_ms{};  // in use: Hello's, brought into 200..2000
  std::uint32_t clock_ms{};
  JointsMicrodeg lower_limits{};
  JointsMicrodeg upper_limits{};
  std::int32_t search_length_max_dmm{};  // 10^-4 mm
  std::int32_t search_speed_max_um_s{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.application, m.arm, m.application_version, m.language_version, m.session, m.last_sequence,
           m.open_sequence, m.heartbeat_timeout_ms, m.clock_ms, m.lower_limits, m.upper_limits,
           m.search_length_max_dmm, m.search_speed_max_um_s);
  }
};

/// Sent every 20 ms after Welcome; dropped, never queued, when the connection is full.
struct State {
  static constexpr MessageType kType = MessageType::kState;
  std::uint32_t session{};
  std::uint32_t clock_ms{};
  std::uint32_t flags{};
  WorkingMode mode{};
  std::int32_t mode_status{};
  std::int32_t emergency_stop{};  // 0 none, 1 released but to be acknowledged, 2 active
  std::int32_t monitor_speed_percent{};
  JointsMicrodeg joints{};          // commanded
  std::uint32_t active_sequence{};  // the running command, 0 for none
  Phase phase{};
  std::int32_t task_error{};  // run-time error number of a task of the application, 0 for none
  PermitState permit{};
  std::int32_t move_id_milli{};  // progress of the queued moves, 1/1000 of a move: for logs
  std::uint32_t overruns{};      // periods that the application's tasks did not finish in, since its start
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.session, m.clock_ms, m.flags, m.mode, m.mode_status, m.emergency_stop, m.monitor_speed_percent,
           m.joints, m.active_sequence, m.phase, m.task_error, m.permit, m.move_id_milli, m.overruns);
  }
};

/// The motion command with the header's sequence has been taken and is being carried out.
struct Accepted {
  static constexpr MessageType kType = MessageType::kAccepted;
  template <class Self, class Fields>
  static constexpr void visit(Self&, Fields&) {}
};

/// The motion command with the header's sequence was refused; nothing moved.
struct Rejected {
  static constexpr MessageType kType = MessageType::kRejected;
  RejectReason reason{};
  std::int32_t detail{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.reason, m.detail);
  }
};

/// How a Touch ended; the header's sequence is the command's. Kept until acknowledged.
struct TouchResult {
  static constexpr MessageType kType = MessageType::kTouchResult;
  Outcome outcome{};
  Phase phase{};                  // reached when it ended early
  CaptureSource source{};         // kNone unless the probe tripped in the (last) search
  JointsMicrodeg contact{};       // joints at the trigger: the second touch's, when there was to be one
  JointsMicrodeg stopped{};       // joints where the arm came to rest behind it
  std::int32_t overtravel_dmm{};  // tool centre's way between both, 10^-4 mm; the longer one of two touches
  std::int32_t search_speed_um_s{};  // at which `contact` was made
  std::int32_t monitor_speed_percent{};
  std::uint32_t contact_clock_ms{};
  std::int32_t error_number{};     // run-time error for kMotionError and kTaskFailed, else 0
  CaptureSource first_source{};    // of the first touch when a second was to follow, else kNone
  JointsMicrodeg first_contact{};  // as contact
  std::uint32_t edges{};           // of the latch input from the trigger to standstill: 1 without bounce
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.outcome, m.phase, m.source, m.contact, m.stopped, m.overtravel_dmm, m.search_speed_um_s,
           m.monitor_speed_percent, m.contact_clock_ms, m.error_number, m.first_source, m.first_contact,
           m.edges);
  }
};

/// How a Travel or Retract ended. Kept until acknowledged.
struct MoveResult {
  static constexpr MessageType kType = MessageType::kMoveResult;
  Outcome outcome{};
  Phase phase{};
  JointsMicrodeg joints{};  // where the arm stands now
  std::int32_t error_number{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.outcome, m.phase, m.joints, m.error_number);
  }
};

/// No command with that sequence in this session, or its result was acknowledged.
struct ResultUnknown {
  static constexpr MessageType kType = MessageType::kResultUnknown;
  std::uint32_t command_sequence{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.command_sequence);
  }
};

/// The connection is closed after this.
struct Fault {
  static constexpr MessageType kType = MessageType::kFault;
  FaultCode code{};
  std::int32_t detail{};
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.code, m.detail);
  }
};

/// What became of Begin, at once and at each change.
struct Permit {
  static constexpr MessageType kType = MessageType::kPermit;
  std::uint32_t run{};  // Begin's
  PermitState state{};
  PermitReason reason{};
  std::int32_t detail{};  // the RejectReason for kRefused, else 0
  template <class Self, class Fields>
  static constexpr void visit(Self& m, Fields& fields) {
    fields(m.run, m.state, m.reason, m.detail);
  }
};

using Payload = std::variant<Hello, Heartbeat, Touch, Travel, Retract, Stop, ResultQuery, ResultAcknowledge,
                             Begin, Finish, Welcome, State, Accepted, Rejected, TouchResult, MoveResult,
                             ResultUnknown, Fault, Permit>;

/// `sequence` is the command's number in a motion command and in all that answers it or a query about it, a
/// counter in State, else 0.
struct Message {
  std::uint32_t sequence{};
  Payload payload;
};

}  // namespace cs8
