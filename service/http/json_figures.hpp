#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "calib_core/units.hpp"

/// How figures and texts look in every document.
namespace cell {

using Json = nlohmann::ordered_json;

/// A figure that is not there, or is no number, is null: never 0, never NaN.
inline Json number(std::optional<double> value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

inline Json number_mm(std::optional<double> value_m) {
  return value_m ? number(calib::mm_from_metres(*value_m)) : Json(nullptr);
}

/// Text from outside (a robot's message, an operator's key) may be no UTF-8: it is shown as far as it is.
inline std::string text_of(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace cell
