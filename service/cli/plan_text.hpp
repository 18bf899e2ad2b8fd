#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace cell {

/// A plan document (touchcal/plan/1) as text: touches per plane, predicted figures, duration, limits.
std::string plan_text(const nlohmann::json& plan);

/// The places tried (touchcal/places/1) as a table, best first.
std::string places_text(const nlohmann::json& places);

}  // namespace cell
