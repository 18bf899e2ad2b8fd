#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "config/truth.hpp"

namespace cell {

/// R_-1 where the block really stands at each place of its file, in R_-1 of the first one: the deviations of
/// the truth on top of the step, which is as warm as block and stand really are. ConfigError for a deviation
/// of a place that the block does not have.
std::vector<Eigen::Isometry3d> true_places(const Truth& truth, const Block& block);

}  // namespace cell
