#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "service/base/json_figures.hpp"

namespace cell {

/// Three numbers as they are asked for.
Json triple_json(const Eigen::Vector3d& values);

/// What an entry of a list is before anything is said of it. `list`: /keep_out_boxes, /tools or
/// /block/places.
Json new_list_entry(const std::string& list, std::size_t index);

}  // namespace cell
