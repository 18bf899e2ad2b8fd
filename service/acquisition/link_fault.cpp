#include "service/acquisition/link_fault.hpp"

#include <algorithm>
#include <array>

namespace cell {
namespace {

FaultCode fault_code_of(cs8::LinkErrorKind kind) {
  switch (kind) {
    case cs8::LinkErrorKind::kIncompatible:
      return FaultCode::kControllerIncompatible;
    case cs8::LinkErrorKind::kProtocol:
    case cs8::LinkErrorKind::kFault:
      return FaultCode::kProtocolError;
    case cs8::LinkErrorKind::kUnreachable:
    case cs8::LinkErrorKind::kOccupied:
    case cs8::LinkErrorKind::kHandshakeTimeout:
    case cs8::LinkErrorKind::kNotConnected:
      return FaultCode::kControllerUnreachable;
    case cs8::LinkErrorKind::kUnanswered:
      return FaultCode::kAnswerMissing;
    case cs8::LinkErrorKind::kPeerClosed:
    case cs8::LinkErrorKind::kSilent:
    case cs8::LinkErrorKind::kClosed:
      break;
  }
  return FaultCode::kLinkLost;
}

}  // namespace

bool is_link_fault(FaultCode code) {
  constexpr std::array kLinkFaults{FaultCode::kControllerUnreachable, FaultCode::kControllerIncompatible,
                                   FaultCode::kProtocolError, FaultCode::kLinkLost,
                                   FaultCode::kAnswerMissing};
  return std::ranges::find(kLinkFaults, code) != kLinkFaults.end();
}

bool explains_hold(const Fault& fault) {
  if (fault.code == FaultCode::kDaemonRestarted) return !fault.detail.empty();
  return !is_link_fault(fault.code);
}

Fault link_fault(const cs8::LinkError& error) { return {fault_code_of(error.kind), error.text}; }

}  // namespace cell
