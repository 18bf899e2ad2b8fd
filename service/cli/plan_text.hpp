#pragma once

#include <string>

#include "service/documents/places_document.hpp"
#include "service/documents/plan_document.hpp"

namespace cell {

/// A plan document (touchcal/plan/1) for people: touches a plane, what they are predicted to give, how long
/// they take, what limits them.
std::string plan_text(const PlanDocument& plan);

/// The places tried (touchcal/places/1) as a table, best first.
std::string places_text(const PlacesDocument& places);

}  // namespace cell
