#pragma once

#include "service/documents/verification_view.hpp"

namespace cell {

/// Of the touches of a tool; see verification_result().
VerificationResult tool_result(const TipRegions& regions, const Run& run, const VerificationContext& context);

}  // namespace cell
