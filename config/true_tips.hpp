#pragma once

#include <vector>

#include "config/truth.hpp"

namespace cell {

/// The probe's tips with centre and radius of each ball as they really are. ConfigError for a deviation of a
/// tip that the probe does not have.
std::vector<ProbeTip> true_tips(const Truth& truth, const Probe& probe);

}  // namespace cell
