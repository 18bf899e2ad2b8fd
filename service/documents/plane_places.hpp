#pragma once

#include <map>
#include <string>

#include "service/documents/result_document.hpp"

namespace cell {

/// The names of the places of a result's planes, by the planes' numbers; of one at the first place there is
/// none.
using PlanePlaces = std::map<int, std::string>;
PlanePlaces plane_places_of(const ResultDocument& result);

/// "2", "8 (stand)": the number as everywhere, and where the plane is touched.
std::string plane_text(int plane, const PlanePlaces& places);

}  // namespace cell
