#pragma once
#include <numbers>
#include <stdexcept>

#include "aimed_touch.hpp"
#include "config/block_place.hpp"
#include "config/place_cell.hpp"
#include "config/truth.hpp"

/// The demo cell whose block can stand 300 mm higher, turned by a quarter.
namespace sim::testing {

inline constexpr const char* kStand = "stand";

inline Eigen::Isometry3d first_from_stand() {
  return Eigen::Translation3d(0.0, -0.3, 0.0) *
         Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY());
}

inline cell::Cell cell_with_stand() {
  cell::Cell cell = read_cell("demo");
  cell.block.places = {
      {.name = kStand, .first_from_place = first_from_stand(), .std = calib::PlaceDeviation{}}};
  return cell;
}

/// As the daemon knows the cell while the block is on the stand.
inline cell::Cell cell_at_stand() {
  cell::Recipe recipe;
  recipe.places = {0};
  return cell::cell_at_place(cell_with_stand(), recipe, 1);
}

/// A touch of the block on the stand: a face may be reached from the one side or the other only.
inline AimedTouch touch_on_stand(int face) {
  for (const double tilt_rad : {0.6, 0.9}) {
    try {
      return aimed_touch(cell_at_stand(), {.face = face, .tilt_rad = tilt_rad});
    } catch (const std::logic_error&) {
      continue;
    }
  }
  return aimed_touch(cell_at_stand(), {.face = face, .tilt_rad = 1.2});
}

}  // namespace sim::testing
