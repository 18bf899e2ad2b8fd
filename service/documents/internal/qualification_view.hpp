#pragma once

#include "config/cell.hpp"
#include "service/documents/verification_view.hpp"

namespace cell {

/// Of a qualification; see verification_result().
VerificationResult qualification_result(const Cell& cell, const Run& run, const VerificationContext& context);

}  // namespace cell
