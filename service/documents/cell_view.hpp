#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// The recipes by name, which one is taken by default, and how many touches each makes.
std::string recipes_document(const Cell& cell);

/// What the cell is made of, in the units of its files.
/// `place`: where the block was located, if it was.
std::string cell_document(const Cell& cell, const std::optional<LocatedPlace>& place);

/// The fault table (service/faults.hpp).
std::string faults_document();

}  // namespace cell
