#pragma once

#include <vector>

#include "service/documents/place_search.hpp"
#include "service/documents/places_document.hpp"

namespace cell {

/// touchcal/places/1: the places tried, best first, each with what is predicted there, or why there is no
/// plan, and what the files of the arm (`frames` 0 and 1) and of the cell (the boxes) hold with the block
/// there.
PlacesDocument places_of(const Cell& cell, const Recipe& recipe, const std::vector<PlaceFinding>& findings);

}  // namespace cell
