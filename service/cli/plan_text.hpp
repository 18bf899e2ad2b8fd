#pragma once

#include <string>

#include "service/documents/places_document.hpp"
#include "service/documents/plan_document.hpp"

namespace cell {

/// A plan document (touchcal/plan/1) as text: touches per plane, predicted figures, duration, limits.
std::string plan_text(const PlanDocument& plan);

/// The places tried (touchcal/places/1) as a table, best first.
std::string places_text(const PlacesDocument& places);

}  // namespace cell
