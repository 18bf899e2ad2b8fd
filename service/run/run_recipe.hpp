#pragma once

#include "config/cell.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// The recipe of a stored run, with the choice of stiffness that it was started with in place of the
/// recipe's. The cell must have a recipe of that name. ConfigError when the cell's arm no longer allows the
/// choice.
Recipe recipe_of(const StoredRun& run, const Cell& cell);

}  // namespace cell
