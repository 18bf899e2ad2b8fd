#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cs8_protocol/messages.hpp"

namespace sim {

/// How the link misbehaves.
enum class Fault {
  // A connection, from now on. At a message, that message is met by it.
  kCloseSocket,  // it ends; the message is lost
  kHalfOpen,     // as with the cable pulled: nothing more is read, written or ended. The message is lost
  kGoSilent,     // the controller works on, but sends nothing more
  kStopStates,   // no State for a time, or for good when none is given: as with a full buffer
  kGarbage,      // bytes that are no frame are sent, in place of the message; a received one is lost
  kRefuse,       // the port is closed for a time; an existing connection stays
  // A message, received or about to be sent.
  kDrop,           // lost
  kDuplicate,      // there twice
  kDelay,          // late by a time; all later messages but States wait with it
  kWrongSequence,  // its sequence is raised by kSequenceOffset
  // A message about to be sent.
  kCloseMidFrame,     // its first half is sent, then the connection ends
  kByteByByte,        // a write for each of its bytes
  kMerge,             // held back and glued to the next
  kWrongVersion,      // another protocol version in its header
  kUnknownType,       // a type that is not listed
  kBadLength,         // a length that is not its type's
  kBadValue,          // its first payload word is no value of the list, or no text
  kWrongSession,      // as from a controller that was restarted in between; of Welcome and State
  kWrongArm,          // of Welcome: another arm's name
  kWrongApplication,  // of Welcome
  kWrongLimits,       // of Welcome: joint 3 goes less far
  kStaleResult,       // of TouchResult: what the touch before said, under the new number
  kWrongJoints,       // of TouchResult: joints that do not belong to the command
};

inline constexpr std::uint32_t kSequenceOffset = 1000;

struct LinkFault {
  LinkFault(Fault kind_, double seconds_ = 0.0) : kind(kind_), seconds(seconds_) {}  // NOLINT: a Fault is one
  Fault kind;
  double seconds;  // wall time; of kDelay, kRefuse and kStopStates (0: for good)
};

/// What a fault can be put at.
enum class FaultTarget { kConnection, kMessage, kSentMessage, kWelcome, kSession, kResult, kValue };
/// Names every fault, so that the compiler finds a new one that is missing here; what a fault does is where
/// its target is: Server, Connection, alter_message() or alter_frame().
FaultTarget target_of(Fault fault);
/// True when such a fault can apply to messages of this type.
bool fits(FaultTarget target, cs8::MessageType type);

/// Changes the message's contents by the fault; a fault of another kind changes nothing. `before` is the
/// touch result that was sent last.
void alter_message(Fault fault, cs8::Message& message, const std::optional<cs8::TouchResult>& before);

/// Changes the frame's bytes by the fault; a fault of another kind changes nothing.
void alter_frame(Fault fault, std::vector<std::uint8_t>& frame);

/// Bytes that are no frame.
std::vector<std::uint8_t> garbage();

}  // namespace sim
