#include "calib_core/swept_collision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace calib {
namespace {

/// Two things that may meet, and when to look at them again.
struct Pair {
  const Capsule* body = nullptr;
  const Capsule* other_body = nullptr;  // or
  const Box* obstacle = nullptr;
  double approach_m = 0.0;  // bound on their relative displacement over the whole move
  double due = 0.0;         // share of the move
};

/// Bound on how far the body's middle line moves, seen from `from_frame`, while the joints turn by `move`.
double displacement_bound_m(const KinematicModel& model, const Capsule& body, int from_frame,
                            const JointVector& move) {
  double lever_m = std::max(body.from_m.norm(), body.to_m.norm());
  double bound_m = 0.0;
  for (int frame = body.frame; frame > from_frame; --frame) {
    const int joint = frame - 1;
    if (joint < kJointCount) {
      const auto index = static_cast<std::size_t>(joint);
      const bool turns = model.joint_types[index] == JointType::kRevolute;
      bound_m += std::abs(model.gains[index] * move[joint]) * (turns ? lever_m : 1.0);
    }
    const LinkParameters& link = model.links[static_cast<std::size_t>(frame)];
    lever_m += std::hypot(link.d_m, link.r_m);
  }
  return bound_m;
}

std::vector<Pair> pairs_of(const CollisionScene& scene, const KinematicModel& model,
                           const JointVector& move) {
  std::vector<Pair> pairs;
  for (const Capsule& body : scene.bodies) {
    const double from_base_m = displacement_bound_m(model, body, 0, move);
    for (const Box& obstacle : scene.obstacles) {
      pairs.push_back({.body = &body, .obstacle = &obstacle, .approach_m = from_base_m});
    }
    for (const Capsule& other : scene.bodies) {
      if (other.frame >= body.frame || are_neighbours(body, other)) continue;
      pairs.push_back({.body = &body,
                       .other_body = &other,
                       .approach_m = displacement_bound_m(model, body, other.frame, move)});
    }
  }
  return pairs;
}

double distance_m(const Pair& pair, const Chain& chain) {
  const Segment body = place(*pair.body, chain);
  if (pair.obstacle) return segment_box_distance_m(body, *pair.obstacle) - pair.body->radius_m;
  const Segment other = place(*pair.other_body, chain);
  return segment_distance_m(body.from_m, body.to_m, other.from_m, other.to_m) - pair.body->radius_m -
         pair.other_body->radius_m;
}

}  // namespace

std::optional<Clash> find_clash_on_way(const CollisionScene& scene, const KinematicModel& model,
                                       const JointVector& from, const JointVector& to, double clearance_m) {
  const JointVector move = to - from;
  std::vector<Pair> pairs = pairs_of(scene, model, move);
  for (double share = 0.0; share <= 1.0;) {
    const Chain chain = forward_chain(model, from + share * move);
    double next = std::numeric_limits<double>::infinity();
    for (Pair& pair : pairs) {
      if (pair.due <= share) {
        const double apart_m = distance_m(pair, chain);
        const double spare_m = apart_m - (pair.obstacle ? clearance_m : 0.0);
        if (spare_m < 0.0) {
          return Clash{pair.body->name, pair.obstacle ? pair.obstacle->name : pair.other_body->name, apart_m};
        }
        // Both ends of a step are clear, so a step twice the allowed error goes no deeper than the error.
        pair.due = share + std::max(spare_m, 2.0 * kSweptErrorMaxMetres) / pair.approach_m;
      }
      next = std::min(next, pair.due);
    }
    if (share == 1.0) break;
    share = std::min(next, 1.0);
    if (share == 1.0) {
      for (Pair& pair : pairs) pair.due = 1.0;
    }
  }
  return std::nullopt;
}

}  // namespace calib
