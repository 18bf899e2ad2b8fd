#pragma once

#include <vector>

#include "service/run/tip_prediction.hpp"
#include "service/store/run_store.hpp"
#include "tests/simulation/record.hpp"

namespace simulation {

/// All runs of a store, oldest first. With `regions` the result of each complete one is computed and judged
/// once more, from its stored touches alone.
std::vector<RunRecord> read_runs(const cell::RunStore& store, const cell::TipRegions* regions);

}  // namespace simulation
