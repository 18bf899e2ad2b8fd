#pragma once

#include <string>

#include "service/run/run.hpp"
#include "service/store/run_outcome.hpp"

namespace cell {

struct VerificationContext {
  bool complete = false;   // every touch was made
  std::string conditions;  // as stored with the run
};

/// The result of a run of another kind than a calibration, as text, and what it is worth.
struct VerificationResult {
  std::string document;
  /// kNone of a check that is part of the reference, kIncomplete where the touches allow no verdict.
  Verdict verdict = Verdict::kIncomplete;
};

/// Of a run that has a verification; touches that were made so far.
VerificationResult verification_result(const TipRegions& regions, const Run& run,
                                       const VerificationContext& context);

}  // namespace cell
