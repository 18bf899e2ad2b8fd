#pragma once

#include <Eigen/Core>
#include <span>
#include <string>

#include "calib_core/motion/collision.hpp"
#include "sim_controller/plant.hpp"

namespace sim {

/// Euclidean distance of a point from a box's surface, negative inside; in a hole, that from its wall.
double box_distance_m(const calib::Box& box, const Eigen::Vector3d& point_m);

/// Distance of the first tip's ball's centre from a surface with this outward normal at which the probe
/// trips: radius - pre-travel + noise; the pre-travel depends on the direction of the push.
double trip_distance_m(const Plant& plant, const Eigen::Isometry3d& block_from_tool,
                       const Eigen::Vector3d& outward, double noise_m);

/// The remaining distance of the true ball to its trip point when R_7 is at `block_from_tool`: distance of
/// its centre from the nearest obstacle, less trip_distance_m(). Positive noise trips early, farther out of
/// the material. Not positive: touched. Of a star stylus the least of all balls: the first one that reaches
/// an obstacle trips.
double trip_gap_m(const Plant& plant, const Eigen::Isometry3d& block_from_tool, double noise_m);

/// How far every body may go before any two can meet; when that is not positive, which two touch.
struct Room {
  double way_m = 0.0;
  std::string hit;  // "stem hit block"
};

/// Bodies against obstacles and against each other, but for neighbours and the bodies with the indices
/// `yielding`.
Room room_around(const calib::CollisionScene& scene, const calib::Chain& chain,
                 std::span<const int> yielding);

}  // namespace sim
