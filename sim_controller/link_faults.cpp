#include "sim_controller/link_faults.hpp"

#include <algorithm>
#include <stdexcept>

#include "cs8_protocol/codec.hpp"

namespace sim {
namespace {

constexpr std::size_t kGarbageSize = 64;
constexpr std::uint8_t kGarbageByte = 0xA5;
// Where the header has what is spoilt.
constexpr std::size_t kVersionByte = 2;
constexpr std::size_t kTypeByte = 3;
constexpr std::size_t kLengthByte = 8;
constexpr std::uint8_t kUnlistedType = 0x7F;
/// In no list of values, and no printable text.
constexpr std::uint8_t kUnlistedByte = 0x7F;
constexpr std::int32_t kDegree = 1'000'000;
/// No model error turns a joint by so much.
constexpr std::int32_t kWrongJointMicrodeg = 20 * kDegree;

void alter_welcome(Fault fault, cs8::Welcome& welcome) {
  if (fault == Fault::kWrongSession) ++welcome.session;
  if (fault == Fault::kWrongArm) welcome.arm = cs8::text16("rx60");
  if (fault == Fault::kWrongApplication) welcome.application = cs8::text16("palletizer");
  if (fault == Fault::kWrongLimits) welcome.upper_limits[2] -= 5 * kDegree;
}

void alter_result(Fault fault, cs8::TouchResult& result, const std::optional<cs8::TouchResult>& before) {
  if (fault == Fault::kStaleResult && before) result = *before;
  if (fault == Fault::kWrongJoints) result.contact[0] += kWrongJointMicrodeg;
}

}  // namespace

FaultTarget target_of(Fault fault) {
  switch (fault) {
    case Fault::kCloseSocket:
    case Fault::kHalfOpen:
    case Fault::kGoSilent:
    case Fault::kStopStates:
    case Fault::kGarbage:
    case Fault::kRefuse:
      return FaultTarget::kConnection;
    case Fault::kDrop:
    case Fault::kDuplicate:
    case Fault::kDelay:
    case Fault::kWrongSequence:
      return FaultTarget::kMessage;
    case Fault::kCloseMidFrame:
    case Fault::kByteByByte:
    case Fault::kMerge:
    case Fault::kWrongVersion:
    case Fault::kUnknownType:
    case Fault::kBadLength:
      return FaultTarget::kSentMessage;
    case Fault::kBadValue:
      return FaultTarget::kValue;
    case Fault::kWrongSession:
      return FaultTarget::kSession;
    case Fault::kWrongArm:
    case Fault::kWrongApplication:
    case Fault::kWrongLimits:
      return FaultTarget::kWelcome;
    case Fault::kStaleResult:
    case Fault::kWrongJoints:
      return FaultTarget::kResult;
  }
  throw std::logic_error("an unlisted fault");
}

bool fits(FaultTarget target, cs8::MessageType type) {
  using cs8::MessageType;
  switch (target) {
    case FaultTarget::kConnection:
    case FaultTarget::kMessage:
      return true;
    case FaultTarget::kSentMessage:
      return cs8::is_from_controller(type);
    case FaultTarget::kWelcome:
      return type == MessageType::kWelcome;
    case FaultTarget::kSession:
      return type == MessageType::kWelcome || type == MessageType::kState;
    case FaultTarget::kResult:
      return type == MessageType::kTouchResult;
    case FaultTarget::kValue:  // those that begin with a value of a list or with a text
      return type == MessageType::kWelcome || type == MessageType::kRejected ||
             type == MessageType::kTouchResult || type == MessageType::kMoveResult ||
             type == MessageType::kFault;
  }
  throw std::logic_error("an unlisted target");
}

void alter_message(Fault fault, cs8::Message& message, const std::optional<cs8::TouchResult>& before) {
  if (fault == Fault::kWrongSequence) message.sequence += kSequenceOffset;
  if (auto* welcome = std::get_if<cs8::Welcome>(&message.payload)) alter_welcome(fault, *welcome);
  if (auto* result = std::get_if<cs8::TouchResult>(&message.payload)) alter_result(fault, *result, before);
  auto* state = std::get_if<cs8::State>(&message.payload);
  if (state != nullptr && fault == Fault::kWrongSession) ++state->session;
}

void alter_frame(Fault fault, std::vector<std::uint8_t>& frame) {
  if (fault == Fault::kGarbage) frame = garbage();
  if (fault == Fault::kWrongVersion) ++frame[kVersionByte];
  if (fault == Fault::kUnknownType) frame[kTypeByte] = kUnlistedType;
  if (fault == Fault::kBadLength) ++frame[kLengthByte];
  if (fault == Fault::kBadValue) std::fill_n(frame.begin() + cs8::kHeaderSize, 4, kUnlistedByte);
}

std::vector<std::uint8_t> garbage() { return std::vector<std::uint8_t>(kGarbageSize, kGarbageByte); }

}  // namespace sim
