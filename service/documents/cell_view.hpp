#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// The recipes by name, the default one, and the number of touches of each.
std::string recipes_document(const Cell& cell);

/// The parts of the cell, in the units of its files. `place`: the located pose of the block, if any.
std::string cell_document(const Cell& cell, const std::optional<BlockPose>& place);

/// The fault table (service/run/fault_table.hpp).
std::string faults_document();

}  // namespace cell
