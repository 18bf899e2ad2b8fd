#pragma once

#include <vector>

#include "sim_controller/plant.hpp"

namespace sim {

/// Which of the scene's bodies (indices) give way while the probe's seat is open. Of a probe with one tip
/// that is its stylus, the body of the probe that reaches farthest to the tip. Of a star stylus it is all
/// that hangs on the seat: the stylus, the stems of the further tips, and what lies between them.
std::vector<int> yielding_bodies(const Plant& plant);

}  // namespace sim
