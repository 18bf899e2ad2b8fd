#include "service/documents/plane_places.hpp"

namespace cell {
namespace {

/// "stand", "tip left", "stand, tip left"; nothing at the first place with the first tip.
std::string where_touched(const PlaneDistances& plane) {
  std::string where = plane.place.value_or("");
  if (plane.tip) where += (where.empty() ? "tip " : ", tip ") + *plane.tip;
  return where;
}

}  // namespace

PlanePlaces plane_places_of(const ResultDocument& result) {
  PlanePlaces places;
  for (const auto* planes : {&result.planes, &result.planes_held_out, &result.planes_proof})
    for (const PlaneDistances& plane : *planes)
      if (const std::string where = where_touched(plane); !where.empty()) places.emplace(plane.plane, where);
  return places;
}

std::string plane_text(int plane, const PlanePlaces& places) {
  const auto found = places.find(plane);
  const std::string number = std::to_string(plane);
  return found == places.end() ? number : number + " (" + found->second + ")";
}

}  // namespace cell
