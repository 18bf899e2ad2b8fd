#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "calib_core/collision.hpp"
#include "sim_controller/motion.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// The path is looked at every so much of the ball's way at most; a graze with a shorter chord may be missed.
inline constexpr double kContactStepMetres = 0.25e-3;
/// The trip is found to this much of the ball's way.
inline constexpr double kContactPrecisionMetres = 1e-9;

/// Euclidean distance of a point from a box's surface, negative inside.
double box_distance_m(const calib::Box& box, const Eigen::Vector3d& point_m);

/// What is left of the true ball's way to the trip: distance of its centre from the nearest obstacle, less
/// (trip distance + noise). Positive noise trips early, farther out of the material. Not positive: touched.
double trip_gap_m(const Plant& plant, const calib::JointVector& joints, double noise_m);

/// The same of a tool that stands at R_7, with a pre-travel that depends on the direction of the push.
double trip_gap_m(const Plant& plant, const Eigen::Isometry3d& block_from_tool, double noise_m);

/// How far every body may go before any two can meet; when that is not positive, which two touch.
struct Room {
  double way_m = 0.0;
  std::string hit;  // "stem hit block"
};

/// Bodies against obstacles and against each other, but for neighbours and the body with the index
/// `yielding`.
Room room_around(const calib::CollisionScene& scene, const calib::Chain& chain, int yielding);

/// Progress on the path where the true ball first trips, on the touched side of the edge, or nothing; 0 when
/// it trips at once.
std::optional<double> find_trip(const Plant& plant, const Path& path, double noise_m);

/// A body of the true arm, not the ball, in an obstacle or in another body.
struct Hit {
  double progress = 0.0;
  calib::Clash clash;
};

/// Smallest step of the search for a hit, in the way of the farthest body.
inline constexpr double kCollisionStepMetres = 2e-3;

/// The first hit on the path up to `until`, or nothing.
std::optional<Hit> find_hit(const Plant& plant, const Path& path, double until);

}  // namespace sim
