#pragma once

#include <optional>
#include <string>

#include "config/cell.hpp"

namespace cell {

/// SHA-256 in lower-case hex over the files a cell was read from (Cell::files), in that order: of each the
/// JSON with sorted keys and without white space, ended by a line feed. Another layout of a file is the same
/// digest, another figure is not. Nothing for a cell that was not read from files. Throws ConfigError when
/// one cannot be read any more.
std::optional<std::string> configuration_digest(const Cell& cell);

}  // namespace cell
