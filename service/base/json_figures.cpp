#include "service/base/json_figures.hpp"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"

namespace cell {

Json number(std::optional<double> value) {
  return value && std::isfinite(*value) ? Json(*value) : Json(nullptr);
}

Json number_mm(std::optional<double> value_m) {
  return value_m ? number(calib::mm_from_metres(*value_m)) : Json(nullptr);
}

template <class T>
Json value_or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}
template Json value_or_null(const std::optional<bool>&);
template Json value_or_null(const std::optional<int>&);
template Json value_or_null(const std::optional<std::int64_t>&);
template Json value_or_null(const std::optional<std::uint32_t>&);
template Json value_or_null(const std::optional<double>&);
template Json value_or_null(const std::optional<std::string>&);

std::string text_of(const Json& document) {
  return document.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace cell
