#pragma once

#include <vector>

#include "service/documents/place_search.hpp"
#include "service/documents/places_document.hpp"

namespace cell {

/// touchcal/places/1: the places tried, best first, each with its predicted figures or why there is no plan,
/// and with the values for the files of the arm (`frames` 0 and 1) and of the cell (the boxes).
PlacesDocument places_of(const Cell& cell, const Recipe& recipe,
                         const std::vector<PlaceCandidate>& candidates);

}  // namespace cell
