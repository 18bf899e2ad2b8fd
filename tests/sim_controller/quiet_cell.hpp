#pragma once

#include "ride.hpp"
#include "sim_controller/world.hpp"

/// The demo cell without noise.
namespace sim::testing {

inline const cell::Cell& demo() {
  static const cell::Cell cell = testing::read_cell("demo");
  return cell;
}

inline cell::Truth real_truth() {
  return cell::read_truth(testing::cell_folder("demo") + "/truth-real.json");
}

/// The cell without noise, so that a trip is where it must be.
inline Plant quiet_plant(const cell::Truth& truth) {
  Plant plant = make_plant(demo(), truth);
  plant.touch_noise_m = 0.0;
  plant.hidden.repeatability_rad.setZero();
  return plant;
}

}  // namespace sim::testing
