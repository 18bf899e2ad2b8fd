#include "service/run/run_conditions.hpp"

namespace cell {

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
