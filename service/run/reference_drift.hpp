#pragma once

#include <vector>

namespace cell {

/// How far the reference place moved during a run, metres, of its readings in the order in which they were
/// made (each against the first, which is 0): the line through them from the first to the last, less what the
/// noise of the readings alone would make of it. 0 when there are fewer than three, and when noise alone
/// makes as much in more than 3 of 1,000 runs.
double trend_m(const std::vector<double>& readings_m);

}  // namespace cell
