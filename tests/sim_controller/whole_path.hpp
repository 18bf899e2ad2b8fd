#pragma once

#include <optional>

#include "calib_core/motion/collision.hpp"
#include "sim_controller/contact.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

/// What a rigid true arm meets on a whole path, worked out at once: the reference for the world, which looks
/// tick by tick.
namespace sim::testing {

/// Smallest step of the search for a hit, in the way of the farthest body.
inline constexpr double kCollisionStepMetres = 2e-3;

/// A body of the true arm, not the ball, in an obstacle or in another body.
struct Hit {
  double progress = 0.0;
  calib::Clash clash;
};

/// What is left of the true ball's way to the trip: distance of its centre from the nearest obstacle, less
/// (trip distance + noise). Positive noise trips early, farther out of the material. Not positive: touched.
double trip_gap_m(const Plant& plant, const calib::JointVector& joints, double noise_m);

/// Progress on the path where the true ball first trips, on the touched side of the edge, or nothing; 0 when
/// it trips at once.
std::optional<double> find_trip(const Plant& plant, const Path& path, double noise_m);

/// The first hit on the path up to `until`, or nothing.
std::optional<Hit> find_hit(const Plant& plant, const Path& path, double until);

}  // namespace sim::testing
