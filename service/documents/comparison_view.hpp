#pragma once

#include <cstdint>

#include "calib_core/proof/comparison.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "service/documents/comparison_document.hpp"

namespace cell {

/// What the comparison of two runs says, in words too. `box`: the postures of the cell's workspace box.
ComparisonDocument comparison_view(std::int64_t earlier, std::int64_t later,
                                   const calib::Comparison& comparison, const calib::TipRegion& box);

}  // namespace cell
