#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/kinematic_model.hpp"

/// By hand rather than with FCL: capsules against boxes and capsules need two distances with a closed form,
/// exact but for rounding and without a virtual call, which a plan takes millions of times, and calib_core
/// needs no further library.
namespace calib {

/// A body of the arm or the probe: all points within radius_m of a segment, fixed in one frame of the arm.
struct Capsule {
  std::string name;
  int frame = 0;  // 0 to 7: the body moves with R_frame
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
  double radius_m = 0.0;
  double margin_m = 0.0;  // kept to obstacles beyond the clearance that is asked for
};

/// An obstacle: a box with edges along R_-1's axes.
struct Box {
  std::string name;
  Eigen::Vector3d min_m;
  Eigen::Vector3d max_m;
};

/// What may collide. Bodies are in order from the base to the stylus.
struct CollisionScene {
  std::vector<Capsule> bodies;
  std::vector<Box> obstacles;
};

/// Two things that are too near: body against obstacle or body against body.
struct Clash {
  std::string body;
  std::string other;
  double distance_m = 0.0;  // between the surfaces, negative when they overlap
};

/// The middle line of a body, in R_-1.
struct Segment {
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
};

/// Where a body is.
Segment place(const Capsule& body, const Chain& chain);

/// Bodies whose frames are at most this many joints apart never clash with each other: they meet at a joint
/// in every posture, and the joint ranges keep them off each other.
inline constexpr int kNeighbourFrames = 2;

inline bool are_neighbours(const Capsule& a, const Capsule& b) {
  return std::abs(a.frame - b.frame) <= kNeighbourFrames;
}

/// From a box to the nearest point of a segment, zero when they meet. Exact but for rounding.
Eigen::Vector3d segment_box_gap_m(const Segment& segment, const Box& box);

/// Shortest distance between a segment and a box, 0 when they meet. Exact but for rounding.
double segment_box_distance_m(const Segment& segment, const Box& box);

/// segment_box_distance_m() >= distance_m, mostly without working it out; false for what is not a number.
bool is_apart(const Segment& segment, const Box& box, double distance_m);

/// Distance between the surface of a capsule given by its end points in R_-1 and a box; negative inside is
/// not promised to be exact, only to be <= 0.
double capsule_box_distance_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double radius_m,
                              const Box& box);

/// Shortest distance between two segments, either of which may be a point.
double segment_distance_m(const Eigen::Vector3d& from_a, const Eigen::Vector3d& to_a,
                          const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_b);

/// segment_distance_m() >= distance_m, mostly without working it out; false for what is not a number.
bool is_apart(const Segment& a, const Segment& b, double distance_m);

/// The arm's bodies keep this distance from each other wherever a clearance is asked for that is not smaller:
/// an arm that is not nominal has its own bodies a few millimetres elsewhere, but they move together.
inline constexpr double kSelfClearanceMetres = 0.01;

inline double self_clearance_m(double clearance_m) { return std::min(clearance_m, kSelfClearanceMetres); }

/// The first pair nearer than `clearance_m` and the body's margin (obstacles) or self_clearance_m() of it
/// (arm against itself), or nothing. Neighbours (are_neighbours) never clash with each other.
std::optional<Clash> find_clash(const CollisionScene& scene, const Chain& chain, double clearance_m);

}  // namespace calib
