#include "calib_core/swept_collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace calib {
namespace {

/// Two things that may meet.
struct Pair {
  const Capsule* body = nullptr;
  const Capsule* other_body = nullptr;  // or
  const Box* obstacle = nullptr;
  double approach_m = 0.0;  // bound on their relative displacement over the whole move
};

/// Bound on how far the body's middle line moves, seen from `from_frame`, while the joints move by `move`.
double displacement_bound_m(const KinematicModel& model, const Capsule& body, int from_frame,
                            const JointVector& move) {
  // The frames behind the last joint do not turn: there the ends are known exactly.
  int frame = body.frame;
  std::array<Eigen::Vector3d, 2> ends_m{body.from_m, body.to_m};
  for (; frame > kJointCount; --frame) {
    for (auto& end_m : ends_m) end_m = frame_transform(model.links[static_cast<std::size_t>(frame)]) * end_m;
  }
  // The lever is a bound on the distance from the joint's axis: the distance itself at the body's own joint.
  double lever_m = std::max(ends_m[0].head<2>().norm(), ends_m[1].head<2>().norm());
  double from_origin_m = std::max(ends_m[0].norm(), ends_m[1].norm());
  double bound_m = 0.0;
  for (; frame > from_frame; --frame) {
    const auto joint = static_cast<std::size_t>(frame - 1);
    const bool turns = model.joint_types[joint] == JointType::kRevolute;
    bound_m += std::abs(model.gains[joint] * move[frame - 1]) * (turns ? lever_m : 1.0);
    const LinkParameters& link = model.links[static_cast<std::size_t>(frame)];
    from_origin_m += std::hypot(link.d_m, link.r_m);
    lever_m = from_origin_m;
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
  const std::vector<Pair> pairs = pairs_of(scene, model, move);
  for (double share = 0.0;;) {
    const Chain chain = forward_chain(model, from + share * move);
    double step = std::numeric_limits<double>::infinity();
    for (const Pair& pair : pairs) {
      const double apart_m = distance_m(pair, chain);
      const double spare_m =
          apart_m - (pair.obstacle ? clearance_m + pair.body->margin_m : self_clearance_m(clearance_m));
      if (!(spare_m >= 0.0)) {  // not-a-number is not clear either
        return Clash{pair.body->name, pair.obstacle ? pair.obstacle->name : pair.other_body->name, apart_m};
      }
      // Both ends of a step are clear, so a step of twice the allowed error goes no deeper than the error.
      step = std::min(step, std::max(spare_m, 2.0 * kSweptErrorMaxMetres) / pair.approach_m);
    }
    if (share == 1.0) return std::nullopt;
    share = std::min(share + step, 1.0);
  }
}

}  // namespace calib
