#include "calib_core/proof/internal/length_text.hpp"

#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace calib {

std::string length_text(double metres) {
  const std::string text = std::to_string(std::round(1e3 * mm_from_metres(metres)) * 1e-3);
  return text.substr(0, text.find('.') + 4) + " mm";
}

}  // namespace calib
