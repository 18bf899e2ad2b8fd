#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/geometry/box.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// By hand rather than with FCL: capsules against boxes and capsules need two distances with a closed form,
/// exact but for rounding and without a virtual call, which a plan takes millions of times, and calib_core
/// needs no further library.
namespace calib {

/// Collision checks of capsules and boxes, which may be rounded; a ball is one. A library for general shapes
/// would not give the distance of a capsule and a box exactly, nor the bound on motion that
/// swept_collision.hpp needs.

/// A body of the arm or the probe: all points within radius_m of a segment that is fixed in one frame.
struct Capsule {
  std::string name;
  int frame = 0;  // 0 to 7
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
  double radius_m = 0.0;
  double margin_m = 0.0;  // additional clearance to obstacles
  double loose_m = 0.0;   // how far it may be from there against the ball that touches; in the margin already
};

/// Everything that may collide. Bodies are ordered from the base to the stylus.
struct CollisionScene {
  std::vector<Capsule> bodies;
  std::vector<Box> obstacles;
};

/// Two objects that are too close: a body and an obstacle, or two bodies.
struct Clash {
  std::string body;
  std::string other;
  double distance_m = 0.0;  // between the surfaces, negative when they overlap
};

/// The axis of a capsule, in R_-1.
struct Segment {
  Eigen::Vector3d from_m;
  Eigen::Vector3d to_m;
};

/// The axis of a body in R_-1.
Segment axis_in_block(const Capsule& body, const Chain& chain);

/// Bodies whose frames are at most this many joints apart are not checked against each other: they overlap at
/// their joint in every posture, and the joint limits prevent collisions.
inline constexpr int kNeighbourFrames = 2;

inline bool are_neighbours(const Capsule& a, const Capsule& b) {
  return std::abs(a.frame - b.frame) <= kNeighbourFrames;
}

/// A part of a segment, as shares of its length.
struct Part {
  double from = 0.0;
  double to = 1.0;
  [[nodiscard]] bool is_empty() const { return !(from <= to); }
};

/// The part of a segment that is less than `margin_m` from a box along every axis; without round_m and holes.
Part part_near(const Segment& segment, const Box& box, double margin_m);

/// Vector from a box without its round_m to the nearest point of a segment, zero when they intersect. Exact
/// up to rounding. Of a box with holes its length is a bound that the distance does not fall below, and that
/// no motion by less can bring to zero: inside a hole that from the wall, above it at least that from the
/// plane of its mouth, and the same inside the rim. It then points out of the wall that is nearest.
Eigen::Vector3d segment_box_gap_m(const Segment& segment, const Box& box);

/// Shortest distance between a segment and a box, 0 when they intersect. Exact up to rounding, of a box with
/// holes the bound of segment_box_gap_m().
double segment_box_distance_m(const Segment& segment, const Box& box);

/// segment_box_distance_m() >= distance_m, mostly without computing it; false for NaN.
bool is_apart(const Segment& segment, const Box& box, double distance_m);

/// Distance between the surface of a capsule, given by its end points in R_-1, and a box. When they overlap
/// it is
/// <= 0 but not the penetration depth.
double capsule_box_distance_m(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double radius_m,
                              const Box& box);

/// Shortest distance between two segments, either of which may be a point.
double segment_distance_m(const Eigen::Vector3d& from_a, const Eigen::Vector3d& to_a,
                          const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_b);

/// segment_distance_m() >= distance_m, mostly without computing it; false for NaN.
bool is_apart(const Segment& a, const Segment& b, double distance_m);

/// Largest clearance that is required between bodies of the arm. Errors of the arm move its bodies by a few
/// millimetres, but all of them together.
inline constexpr double kSelfClearanceMetres = 0.01;

inline double self_clearance_m(double clearance_m) { return std::min(clearance_m, kSelfClearanceMetres); }

/// The first pair that is closer than `clearance_m` plus the margin of the body (obstacles) or
/// self_clearance_m() (two bodies), or nothing. Neighbours are not checked.
std::optional<Clash> find_clash(const CollisionScene& scene, const Chain& chain, double clearance_m);

}  // namespace calib
