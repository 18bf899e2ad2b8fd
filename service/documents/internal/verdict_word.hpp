#pragma once

#include "service/documents/verification_document.hpp"
#include "service/store/run_outcome.hpp"

namespace cell {

/// What a run is worth whose result has this verdict; without one it is incomplete.
inline Verdict verdict_of(const VerificationVerdict& verdict) {
  if (!verdict.accepted) return Verdict::kIncomplete;
  return *verdict.accepted ? Verdict::kAccepted : Verdict::kRejected;
}

}  // namespace cell
