#include "service/documents/plane_places.hpp"

namespace cell {

std::string where_touched(const std::optional<std::string>& place, const std::optional<std::string>& tip) {
  std::string where = place.value_or("");
  if (tip) where += (where.empty() ? "tip " : ", tip ") + *tip;
  return where;
}

std::string where_in_row(const std::optional<std::string>& place, const std::optional<std::string>& tip) {
  if (!place && !tip) return {};
  return (place ? "  at " : "  ") + where_touched(place, tip);
}

PlanePlaces plane_places_of(const ResultDocument& result) {
  PlanePlaces places;
  for (const auto* planes : {&result.planes, &result.planes_held_out, &result.planes_proof})
    for (const PlaneDistances& plane : *planes)
      if (const std::string where = where_touched(plane.place, plane.tip); !where.empty())
        places.emplace(plane.plane, where);
  return places;
}

std::string plane_text(int plane, const PlanePlaces& places) {
  const auto found = places.find(plane);
  const std::string number = std::to_string(plane);
  return found == places.end() ? number : number + " (" + found->second + ")";
}

}  // namespace cell
