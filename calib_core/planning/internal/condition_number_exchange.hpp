#pragma once

#include "calib_core/planning/internal/fedorov_exchange.hpp"

namespace calib {

/// Exchanges candidates until the condition number of the chosen rows (largest over smallest singular value
/// of the unscaled columns) decreases no more. Candidates are ranked by a smooth substitute, a power mean of
/// the variances along the principal directions that is dominated by the worst ones; the best of a short list
/// is then chosen by the condition number itself.
void reduce_condition_number(FedorovExchange& exchange);

}  // namespace calib
