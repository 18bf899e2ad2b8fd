#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// Touches of one face at one place, whose stylus leans one way and is turned about itself; and among them
/// those that are turned alike.
struct TurnedTouches {
  std::vector<std::size_t> all;      // by their index, in their order
  std::vector<std::size_t> repeats;  // of the turn that most of them have
  int directions = 0;                // different turns
};

/// Two touches whose balls are farther apart along the face, metres, or whose styluses lean differently by
/// more, radians, are not of one place. Across the face a bent stylus alone sets them apart: that does not
/// count.
inline constexpr double kSameTurningPlaceMetres = 5e-3;
inline constexpr double kSameLeanRadians = 0.02;
/// Turns that differ by less are one.
inline constexpr double kSameTurnRadians = 0.1;

/// Those of the place that most have; of several the first. By the nominal arm; every touch is on one of the
/// surfaces.
TurnedTouches turned_touches(const KinematicModel& nominal, std::span<const ContactSurface> surfaces,
                             std::span<const Touch> touches);

}  // namespace calib
