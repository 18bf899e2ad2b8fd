#pragma once

#include <Eigen/Core>

#include "service/base/json_figures.hpp"

namespace cell {

/// Three numbers as they are asked for.
Json triple_json(const Eigen::Vector3d& values);

}  // namespace cell
