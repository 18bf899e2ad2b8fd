#pragma once

#include <cstdint>
#include <vector>

#include "service/documents/checks_view.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// The checks of a calibration that came to their end, oldest first. One whose result cannot be read has no
/// verdict. Throws what the store throws.
std::vector<EndedCheck> checks_of(const RunStore& store, std::int64_t calibration);

}  // namespace cell
