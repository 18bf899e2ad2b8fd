#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <variant>

#include "cs8_protocol/codes.hpp"

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
  Phase phase{};             // reached when it ended early
  CaptureSource source{};    // kNone unless the probe tripped in the (last) search
  JointsMicrodeg contact{};  // joints at the trigger: the second touch's, when there was to be one
  JointsMicrodeg stopped{};  // joints where the arm came to rest after it
  std::int32_t
      overtravel_dmm{};  // path of the tool centre between both, 10^-4 mm; the longer one of two touches
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
  JointsMicrodeg joints{};  // of the arm now
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
