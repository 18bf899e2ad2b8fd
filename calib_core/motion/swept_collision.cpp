#include "calib_core/motion/swept_collision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace calib {
namespace {

double distance_m(const Segment& a, const Segment& b) {
  return segment_distance_m(a.from_m, a.to_m, b.from_m, b.to_m);
}

/// Bounds on the position of a body's axis relative to the joints after a frame, in any posture.
struct Reach {
  JointVector levers_m = JointVector::Zero();   // distance from each joint's axis; 1 for a prismatic joint
  JointVector origins_m = JointVector::Zero();  // ... from each joint's origin
};

Reach reach_of(const KinematicModel& model, const Capsule& body, int from_frame) {
  // The frames after the last joint are fixed to it: the ends are known exactly there.
  int frame = body.frame;
  std::array<Eigen::Vector3d, 2> ends_m{body.from_m, body.to_m};
  for (; frame > kJointCount; --frame) {
    for (auto& end_m : ends_m) end_m = frame_transform(model.links[static_cast<std::size_t>(frame)]) * end_m;
  }
  // A bound on the distance from the joint's axis; exact at the body's own joint.
  double lever_m = std::max(ends_m[0].head<2>().norm(), ends_m[1].head<2>().norm());
  double from_origin_m = std::max(ends_m[0].norm(), ends_m[1].norm());
  Reach reach;
  for (; frame > from_frame; --frame) {
    const bool turns = model.joint_types[static_cast<std::size_t>(frame - 1)] == JointType::kRevolute;
    reach.levers_m[frame - 1] = turns ? lever_m : 1.0;
    reach.origins_m[frame - 1] = turns ? from_origin_m : 1.0;
    const LinkParameters& link = model.links[static_cast<std::size_t>(frame)];
    from_origin_m += std::hypot(link.d_m, link.r_m);
    lever_m = from_origin_m;
  }
  return reach;
}

}  // namespace

/// The motion of the arm at one point of a move; time runs from 0 to 1 over the move.
struct SweptCollision::Motion {
  JointVector moved;         // absolute motion of each axis
  JointVector turned_until;  // sum of `moved` over the previous axes and over all axes
  std::array<Eigen::Vector3d, kFrameCount> turn,
      go;  // of each frame: angular velocity, velocity of its origin
  std::array<Eigen::Vector3d, kFrameCount> origin_m;

  Motion(const KinematicModel& model, const JointVector& move);
  void evaluate(const KinematicModel& model, const JointVector& move, const Chain& chain);
};

SweptCollision::Motion::Motion(const KinematicModel& model, const JointVector& move) {
  double before = 0.0;
  for (int joint = 0; joint < kJointCount; ++joint) {
    moved[joint] = std::abs(model.gains[static_cast<std::size_t>(joint)] * move[joint]);
    turned_until[joint] = before;
    before += moved[joint];
  }
  turned_until.array() += before;
}

void SweptCollision::Motion::evaluate(const KinematicModel& model, const JointVector& move,
                                      const Chain& chain) {
  turn[0] = go[0] = Eigen::Vector3d::Zero();
  origin_m[0] = chain.block_from_frame[0].translation();
  for (std::size_t frame = 1; frame < kFrameCount; ++frame) {
    const Eigen::Isometry3d& here = chain.block_from_frame[frame];
    origin_m[frame] = here.translation();
    turn[frame] = turn[frame - 1];
    go[frame] = go[frame - 1];
    if (frame <= kJointCount) {
      const std::size_t joint = frame - 1;
      const Eigen::Vector3d own =
          model.gains[joint] * move[static_cast<Eigen::Index>(joint)] * here.linear().col(2);
      (model.joint_types[joint] == JointType::kRevolute ? turn : go)[frame] += own;
    }
    go[frame] += turn[frame - 1].cross(origin_m[frame] - origin_m[frame - 1]);
  }
}

SweptCollision::SweptCollision(const CollisionScene& scene, const KinematicModel& model, double clearance_m)
    : scene_(scene), prepared_(prepare(model)) {
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const Capsule& body = scene_.bodies[i];
    const Reach from_base = reach_of(model, body, 0);
    for (std::size_t k = 0; k < scene_.obstacles.size(); ++k) {
      pairs_.push_back({i, k, true, body.radius_m + clearance_m + body.margin_m + scene_.obstacles[k].round_m,
                        from_base.levers_m, from_base.origins_m});
    }
    for (std::size_t k = 0; k < scene_.bodies.size(); ++k) {
      const Capsule& other = scene_.bodies[k];
      if (other.frame >= body.frame || are_neighbours(body, other)) continue;
      pairs_.push_back({i, k, false, body.radius_m + other.radius_m + self_clearance_m(clearance_m),
                        reach_of(model, body, other.frame).levers_m, JointVector::Zero()});
    }
  }
}

Clash SweptCollision::clash(const Pair& pair, double gap_m) const {
  const Capsule& body = scene_.bodies[pair.body];
  if (pair.is_obstacle) {
    const Box& obstacle = scene_.obstacles[pair.other];
    return {body.name, obstacle.name, gap_m - body.radius_m - obstacle.round_m};
  }
  const Capsule& other = scene_.bodies[pair.other];
  return {body.name, other.name, gap_m - body.radius_m - other.radius_m};
}

/// The time for which the body certainly stays clear of this obstacle. The obstacle lies behind the plane
/// through its nearest point with the normal of the gap; both ends of the body have to travel the gap first.
double SweptCollision::safe_step(const Pair& pair, const Motion& motion, const Segment& body,
                                 const Eigen::Vector3d& gap_m) const {
  const double apart_m = gap_m.norm(), spare_m = apart_m - pair.required_m;
  const auto frame = static_cast<std::size_t>(scene_.bodies[pair.body].frame);
  const Eigen::Vector3d& origin_m = motion.origin_m[frame];
  const auto leaving = [&](const Eigen::Vector3d& end_m) {
    return gap_m.dot(motion.go[frame] + motion.turn[frame].cross(end_m - origin_m)) / apart_m;
  };
  const double speed = std::min(leaving(body.from_m), leaving(body.to_m));
  // Bound on |d2 p / dt2| of a point: the rotation of joint j acts on the lever from its origin. The
  // rotations of the previous joints change axis and lever, those from j on the lever only.
  const double acceleration = motion.moved.cwiseProduct(pair.reaches_m).dot(motion.turned_until);
  return (speed + std::sqrt(speed * speed + 2.0 * acceleration * spare_m)) / acceleration;
}

std::optional<Clash> SweptCollision::find_clash(const JointVector& from, const JointVector& to) const {
  // Both ends of a step are clear, so a step of twice the allowed error penetrates by at most the error.
  constexpr double kStepMinMetres = 2.0 * kSweptErrorMaxMetres;
  constexpr double kEarly = 0.5;
  const JointVector move = to - from;
  Motion motion(prepared_.model, move);
  std::vector<Segment> axes(scene_.bodies.size());
  // Times when each pair has to be checked next, and when it is checked if another pair is due.
  std::vector<double> due(pairs_.size(), 0.0), early(pairs_.size(), 0.0);
  for (double share = 0.0; share <= 1.0;) {
    const Chain chain = forward_chain(prepared_, from + share * move);
    motion.evaluate(prepared_.model, move, chain);
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = axis_in_block(scene_.bodies[i], chain);
    double next = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (early[i] <= share) {
        const Pair& pair = pairs_[i];
        const Segment& body = axes[pair.body];
        const Eigen::Vector3d box_gap_m = pair.is_obstacle
                                              ? segment_box_gap_m(body, scene_.obstacles[pair.other])
                                              : Eigen::Vector3d::Zero();
        const double apart_m = pair.is_obstacle ? box_gap_m.norm() : distance_m(body, axes[pair.other]);
        const double spare_m = apart_m - pair.required_m;
        if (!(spare_m >= 0.0)) return clash(pair, apart_m);  // NaN is not clear either
        const double approach_m = pair.levers_m.dot(motion.moved);
        double step = spare_m / approach_m;
        // A box with holes does not lie behind such a plane.
        if (pair.is_obstacle && apart_m > 0.0 && scene_.obstacles[pair.other].holes.empty()) {
          step = std::max(step, safe_step(pair, motion, body, box_gap_m));
        }
        due[i] = share + std::max(step, kStepMinMetres / approach_m);
        if (step < kStepMinMetres / approach_m && share < 1.0) due[i] = std::min(due[i], 1.0);
        early[i] = std::min(due[i], share + kEarly * (due[i] - share));
      }
      next = std::min(next, due[i]);
    }
    share = next;
  }
  return std::nullopt;
}

std::optional<Clash> find_clash_on_move(const CollisionScene& scene, const KinematicModel& model,
                                        const JointVector& from, const JointVector& to, double clearance_m) {
  return SweptCollision(scene, model, clearance_m).find_clash(from, to);
}

}  // namespace calib
