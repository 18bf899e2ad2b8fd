#pragma once

#include <map>
#include <optional>
#include <string>

#include "service/documents/result_document.hpp"

namespace cell {

/// "stand", "tip left", "stand, tip left"; nothing at the first place with the first tip.
std::string where_touched(const std::optional<std::string>& place, const std::optional<std::string>& tip);

/// The same behind the figures of a row: "  at stand, tip left", "  tip left".
std::string where_in_row(const std::optional<std::string>& place, const std::optional<std::string>& tip);

/// Where a result's planes are touched, by the planes' numbers; of one that the first tip touches at the
/// first place there is nothing.
using PlanePlaces = std::map<int, std::string>;
PlanePlaces plane_places_of(const ResultDocument& result);

/// "2", "8 (stand)": the number as everywhere, and where the plane is touched.
std::string plane_text(int plane, const PlanePlaces& places);

}  // namespace cell
