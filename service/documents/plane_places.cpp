#include "service/documents/plane_places.hpp"

namespace cell {

PlanePlaces plane_places_of(const ResultDocument& result) {
  PlanePlaces places;
  for (const auto* planes : {&result.planes, &result.planes_held_out, &result.planes_proof})
    for (const PlaneDistances& plane : *planes)
      if (plane.place) places.emplace(plane.plane, *plane.place);
  return places;
}

std::string plane_text(int plane, const PlanePlaces& places) {
  const auto found = places.find(plane);
  const std::string number = std::to_string(plane);
  return found == places.end() ? number : number + " (" + found->second + ")";
}

}  // namespace cell
