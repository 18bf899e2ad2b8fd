#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"

namespace cell {

/// SHA-256, lower-case hexadecimal, over the files that a cell was read from (Cell::files), in their order:
/// the JSON of each with sorted keys and without white space, followed by a line feed. The layout of a file
/// does not matter, its figures do, except `check_every_days` and `target_frames` of the cell's file. Nothing
/// for a cell that was not read from files. Throws ConfigError if a file can no longer be read.
std::optional<std::string> configuration_digest(const Cell& cell);

}  // namespace cell
