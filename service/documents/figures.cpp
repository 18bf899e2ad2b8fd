#include "service/documents/figures.hpp"

#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace cell {

std::optional<double> finite(std::optional<double> value) {
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<double> finite_mm(std::optional<double> value_m) {
  return value_m ? finite(calib::mm_from_metres(*value_m)) : std::nullopt;
}

}  // namespace cell
