#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/run/run.hpp"

namespace cell {

/// Why stored touches cannot be those of a run of this cell, before it has its plan: numbers that do not
/// follow each other, a plane that the block has at no place of the recipe. One sentence that names the first
/// such touch.
std::optional<std::string> why_no_touches_of(const Cell& cell, const Recipe& recipe,
                                             const std::vector<StoredTouch>& touches);

/// A stored touch farther than this from the orientation of the planned one was not aimed at it; radians.
inline constexpr double kRestoredTurnMaxRad = 0.1;

/// Why the touches of a restored run cannot be those of its plan, of which they are the beginning: another
/// plane or role, or a contact out of reach of the planned search. A search is aimed at the planned point
/// with the estimate of the arm: by the nominal arm it is as far off as the nominal position error at most.
/// Touches `by_hand` are anywhere on their plane. One sentence that names the first such touch.
std::optional<std::string> why_not_of_plan(const Cell& cell, const Run& run, bool by_hand);

}  // namespace cell
