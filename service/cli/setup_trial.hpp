#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/cell.hpp"

/// Whether the runs of a new cell can be planned, before its files are written.
namespace cell {

struct RecipeTrial {
  std::map<std::string, double> tip_box_max_mm;  // by recipe: what its plan promises and half of it more
  std::vector<std::string> remarks;              // why a recipe that is not the default one has no plan
};

/// Plans each recipe of the cell, or the default one only; takes seconds. ConfigError with the reason where
/// the default recipe has no plan; its pointer is that of the answer that stands in the way.
RecipeTrial try_recipes(const Cell& cell, bool only_default);

/// The same without a plan, in less than a second: looks for some touches of each face. ConfigError likewise
/// where one cannot be touched at all.
void demand_touchable_faces(const Cell& cell);

}  // namespace cell
