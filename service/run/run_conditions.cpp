#include "service/run/run_conditions.hpp"

#include <cmath>

#include "calib_core/geometry/units.hpp"

namespace cell {

double scatter_um_of(const calib::TouchNoise& noise) {
  constexpr double kDecimals = 1e6;
  return std::round(kDecimals * calib::um_from_metres(noise.std_m)) / kDecimals;
}

std::string_view touch_mode_name(TouchMode touching) {
  switch (touching) {
    case TouchMode::kAutomatic:
      return "automatic";
    case TouchMode::kGuided:
      return "guided";
  }
  return "";
}

}  // namespace cell
