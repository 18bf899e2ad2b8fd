#include "calib_core/planning/touch_feasibility.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "calib_core/geometry/units.hpp"

namespace calib {
namespace {

constexpr double kRangeMarginRad = 1.0 * kRadiansPerDegree;
constexpr double kLineStepMetres = 0.010;
constexpr double kSamePlaneMetres = 1e-6;
/// How often `clear` is moved away from what is near, and how far from where the face alone would have it.
constexpr int kClearMovesMax = 4;
constexpr double kClearMoveMaxMetres = 0.100;

/// How far a box reaches along a direction.
double reach_m(const Box& box, const Eigen::Vector3d& direction) {
  return direction.cwiseProduct(box.min_m).cwiseMax(direction.cwiseProduct(box.max_m)).sum();
}

bool is_in_box(const Box& box, const Eigen::Vector3d& point_m) {
  return (point_m.array() >= box.min_m.array() - kSamePlaneMetres).all() &&
         (point_m.array() <= box.max_m.array() + kSamePlaneMetres).all();
}

/// See make_touch: the probe over the plane of the face it touches.
bool is_over_face(const Capsule& body, const Segment& placed, const Plane& face) {
  const auto end_is_over = [&](const Eigen::Vector3d& end_m, double from_ball_m) {
    return signed_distance_m(face, end_m) - body.radius_m > kOrientationMiss * from_ball_m - kSamePlaneMetres;
  };
  return end_is_over(placed.from_m, body.from_m.norm()) && end_is_over(placed.to_m, body.to_m.norm());
}

/// Whether a straight motion of the tip asks for a joint faster than kJointRateMax. With v = A q1 + B q2 and
/// 0 = C q1 + D q2 (joints 1 to 3 and 4 to 6): the largest singular value of the 6 x 3 matrix q = R v.
bool is_singular(const KinematicModel& model, const Chain& chain) {
  const auto jacobian = pose_jacobian(model, chain);
  const Eigen::Matrix3d wrist_from_arm =
      -jacobian.bottomRightCorner<3, 3>().inverse() * jacobian.bottomLeftCorner<3, 3>();
  const Eigen::Matrix3d arm_rates =
      (jacobian.topLeftCorner<3, 3>() + jacobian.topRightCorner<3, 3>() * wrist_from_arm).inverse();
  const Eigen::Matrix3d wrist_rates = wrist_from_arm * arm_rates;
  // Below the limit if limit^2 - R^T R is positive definite: by its leading minors.
  const Eigen::Matrix3d spare = kJointRateMax * kJointRateMax * Eigen::Matrix3d::Identity() -
                                arm_rates.transpose() * arm_rates - wrist_rates.transpose() * wrist_rates;
  return !(spare(0, 0) > 0.0 && spare.topLeftCorner<2, 2>().determinant() > 0.0 && spare.determinant() > 0.0);
}

bool is_probe(const Capsule& body) { return body.frame == kFrameCount - 1; }

}  // namespace

std::string describe(const PlanningProblem& problem, const Refusal& refusal) {
  const auto body = [&](std::size_t index) { return "the " + problem.scene.bodies[index].name; };
  switch (refusal.cause) {
    case Refusal::Cause::kJointRanges:
      return "joint ranges";
    case Refusal::Cause::kSingular:
      return "postures near a singular one";
    case Refusal::Cause::kOutOfReach:
      return "out of reach along the search";
    case Refusal::Cause::kNearObstacle:
      return body(refusal.body) + " is within " +
             std::to_string(std::lround(mm_from_metres(problem.nominal_miss_m))) + " mm of the " +
             problem.scene.obstacles[refusal.other].name;
    case Refusal::Cause::kHitsItself:
      return body(refusal.body) + " hits " + body(refusal.other);
    case Refusal::Cause::kNoWay:
      break;
  }
  return "no clear way from the park posture";
}

TouchPose sample_touch_pose(const PlanningProblem& problem, const Face& face, UniformChance& chance,
                            double rim_share) {
  const auto on_rim = [&] { return rim_share > 0.0 && chance() < rim_share; };
  const auto along = [&](const Eigen::Vector3d& edge, double half_extent_m) -> Eigen::Vector3d {
    const double even = 2.0 * chance() - 1.0;
    const double place = on_rim() ? std::copysign(1.0, even) : even;
    return place * std::max(half_extent_m - problem.nominal_miss_m, 0.0) * edge;
  };
  const Eigen::Vector3d& outward = face.plane.outward;
  const Eigen::Vector3d on_u = along(face.edge_u, face.half_extent_m.x());
  const Eigen::Vector3d on_v = along(face.edge_v(), face.half_extent_m.y());
  const double even_tilt = chance();
  const double tilt_rad = (on_rim() ? std::cbrt(even_tilt) : even_tilt) * problem.tilt_max_rad;
  const double direction_rad = chance() * 2.0 * std::numbers::pi;
  const double turn_rad = chance() * 2.0 * std::numbers::pi;

  Eigen::Matrix3d straight;  // z into the face
  straight << face.edge_u, -face.edge_v(), -outward;
  TouchPose pose{.tilt_rad = tilt_rad};
  pose.block_from_tip.linear() = straight * Eigen::AngleAxisd(direction_rad, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ());
  // The centre of the rectangle may be given roughly; the touch is on the plane.
  const Eigen::Vector3d point_m = face.center_m + on_u + on_v;
  pose.block_from_tip.translation() =
      point_m + (problem.stylus.radius_m - signed_distance_m(face.plane, point_m)) * outward;
  return pose;
}

TouchHeights touch_heights(double nominal_miss_m, double standoff_min_m) {
  // 3 mm over the miss: the ball is off the face when the search begins and the true face within its reach.
  const double standoff_m = std::max(nominal_miss_m + 0.003, standoff_min_m);
  // The way into the slow zone is a slow one.
  return {.approach_m = standoff_m, .clear_m = standoff_m + kSlowZoneMetres, .search_end_m = -standoff_m};
}

TouchedFace find_touched(const PlanningProblem& problem, int face) {
  const Face& wanted = problem.faces[static_cast<std::size_t>(face)];
  const auto& obstacles = problem.scene.obstacles;
  TouchedFace around{.face = face, .is_behind = std::vector<bool>(obstacles.size(), false)};
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const bool is_side =
        std::abs(reach_m(obstacles[i], wanted.plane.outward) - wanted.plane.offset_m) < kSamePlaneMetres;
    if (is_side && is_in_box(obstacles[i], wanted.center_m)) around.touched = static_cast<int>(i);
  }
  if (around.touched < 0) return around;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    around.is_behind[i] =
        reach_m(obstacles[i], wanted.plane.outward) < wanted.plane.offset_m + kSamePlaneMetres;
  }
  return around;
}

TouchMaker::TouchMaker(const PlanningProblem& problem)
    : problem_(problem),
      prepared_(prepare(problem.nominal)),
      inverse_(problem.nominal),
      ranges_(problem.joint_ranges),
      travel_scene_(travel_scene(problem)),
      space_(problem.nominal, travel_scene_, problem.park_joints, problem.nominal_miss_m) {
  ranges_.lower.array() += kRangeMarginRad;
  ranges_.upper.array() -= kRangeMarginRad;
}

/// One touch in the making: goes its way in either direction and keeps what was wrong.
class TouchMaker::LineOfTouch {
 public:
  LineOfTouch(const TouchMaker& maker, const TouchedFace& around, const TouchPose& pose)
      : maker_(maker), problem_(maker.problem_), around_(around), pose_(pose) {}

  /// From the contact's posture straight to a height, in steps.
  std::optional<JointVector> follow(const JointVector& contact, double to_m) {
    const int steps = steps_over(to_m);
    JointVector joints = contact;
    for (int step = 1; step <= steps; ++step) {
      const double height_m = to_m * step / steps;
      const auto next = maker_.inverse_.follow(moved(height_m * face().plane.outward), joints);
      if (!next) return refuse({Refusal::Cause::kOutOfReach});
      joints = *next;
      if (!check(joints, height_m)) return std::nullopt;
    }
    return joints;
  }

  /// Out of the slow zone from the approach posture, and a way from there.
  std::optional<JointVector> leave(const JointVector& approach, const TouchHeights& heights) {
    const Eigen::Vector3d straight_m = heights.clear_m * face().plane.outward;
    Eigen::Vector3d off_m = straight_m;
    for (int moves = 0; moves <= kClearMovesMax; ++moves) {
      const auto clear = maker_.inverse_.follow(moved(off_m), approach);
      if (!clear || !is_in_range(*clear)) break;
      const Eigen::Vector3d away_m = out_of_slow_zone_m(*clear);
      if (away_m.isZero()) {
        const double way_m = (off_m - heights.approach_m * face().plane.outward).norm();
        if (!check_move(approach, *clear, way_m, heights.approach_m)) return std::nullopt;
        if (!is_near_park(maker_.space_, *clear)) break;
        return clear;
      }
      off_m += away_m;
      if ((off_m - straight_m).norm() > kClearMoveMaxMetres) break;
    }
    return refuse({Refusal::Cause::kNoWay});
  }

  bool check(const JointVector& joints, double height_m) {
    refusal_ = is_in_range(joints) ? find_refusal(joints, height_m) : Refusal{Refusal::Cause::kJointRanges};
    return !refusal_;
  }

  [[nodiscard]] Refusal refusal() const { return refusal_.value(); }

 private:
  static int steps_over(double way_m) {
    return std::max(static_cast<int>(std::ceil(std::abs(way_m) / kLineStepMetres)), 1);
  }

  [[nodiscard]] const Face& face() const { return problem_.faces[static_cast<std::size_t>(around_.face)]; }

  [[nodiscard]] Eigen::Isometry3d moved(const Eigen::Vector3d& off_m) const {
    Eigen::Isometry3d block_from_tip = pose_.block_from_tip;
    block_from_tip.translation() += off_m;
    return block_from_tip;
  }

  [[nodiscard]] bool is_in_range(const JointVector& joints) const { return maker_.ranges_.contains(joints); }

  std::nullopt_t refuse(const Refusal& refusal) {
    refusal_ = refusal;
    return std::nullopt;
  }

  /// A straight joint move, without its beginning.
  bool check_move(const JointVector& from, const JointVector& to, double way_m, double height_m) {
    const int steps = steps_over(way_m);
    for (int step = 1; step <= steps; ++step) {
      if (!check(from + (to - from) * step / steps, height_m)) return false;
    }
    return true;
  }

  /// Where to move the tip so that the body deepest in its slow zone leaves it; zero when all are out.
  [[nodiscard]] Eigen::Vector3d out_of_slow_zone_m(const JointVector& joints) const {
    constexpr double kToSpareMetres = 1e-4;
    const Chain chain = forward_chain(maker_.prepared_, joints);
    double missing_m = 0.0;
    Eigen::Vector3d away = Eigen::Vector3d::Zero();
    for (const Capsule& body : maker_.travel_scene_.bodies) {
      if (!is_probe(body)) continue;
      const Segment placed = place(body, chain);
      const double needed_m = body.radius_m + body.margin_m + problem_.nominal_miss_m;
      for (const Box& obstacle : problem_.scene.obstacles) {
        if (is_apart(placed, obstacle, needed_m + missing_m)) continue;
        const Eigen::Vector3d gap_m = segment_box_gap_m(placed, obstacle);
        if (needed_m - gap_m.norm() <= missing_m) continue;
        missing_m = needed_m - gap_m.norm();
        away = gap_m.normalized();
      }
    }
    return missing_m > 0.0 ? Eigen::Vector3d((missing_m + kToSpareMetres) * away) : Eigen::Vector3d::Zero();
  }

  [[nodiscard]] std::optional<Refusal> find_refusal(const JointVector& joints, double height_m) const {
    const Chain chain = forward_chain(maker_.prepared_, joints);
    if (is_singular(problem_.nominal, chain)) return Refusal{Refusal::Cause::kSingular};
    const auto& bodies = problem_.scene.bodies;
    std::vector<Segment> placed;
    placed.reserve(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      placed.push_back(place(bodies[i], chain));
      if (const auto obstacle = find_obstacle(bodies[i], placed[i], height_m)) {
        return Refusal{Refusal::Cause::kNearObstacle, i, *obstacle};
      }
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (are_neighbours(bodies[i], bodies[j])) continue;
        const double apart_m = bodies[i].radius_m + bodies[j].radius_m + kSelfClearanceMetres;
        if (!is_apart(placed[i], placed[j], apart_m)) return Refusal{Refusal::Cause::kHitsItself, i, j};
      }
    }
    return std::nullopt;
  }

  /// The first that a body is too near to.
  [[nodiscard]] std::optional<std::size_t> find_obstacle(const Capsule& body, const Segment& placed,
                                                         double height_m) const {
    const auto& obstacles = problem_.scene.obstacles;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      if (height_m < 0.0 && around_.is_behind[i]) continue;
      if (is_apart(placed, obstacles[i], body.radius_m + body.margin_m + problem_.nominal_miss_m)) continue;
      const bool may_be_near = is_probe(body) && around_.is_behind[i];
      if (may_be_near && is_over_face(body, placed, face().plane)) continue;
      return i;
    }
    return std::nullopt;
  }

  const TouchMaker& maker_;
  const PlanningProblem& problem_;
  const TouchedFace& around_;
  const TouchPose& pose_;
  std::optional<Refusal> refusal_;
};

std::variant<PlannedTouch, Refusal> TouchMaker::make(const TouchedFace& around, const TouchPose& pose,
                                                     const JointVector& joints) const {
  const TouchHeights heights = touch_heights(problem_.nominal_miss_m, problem_.standoff_min_m);
  LineOfTouch line(*this, around, pose);
  if (!line.check(joints, 0.0)) return line.refusal();
  const auto approach = line.follow(joints, heights.approach_m);
  if (!approach) return line.refusal();
  const auto search_end = line.follow(joints, heights.search_end_m);
  if (!search_end) return line.refusal();
  const auto clear = line.leave(*approach, heights);
  if (!clear) return line.refusal();
  return PlannedTouch{
      .face = around.face,
      .joints = joints,
      .clear_joints = *clear,
      .approach_joints = *approach,
      .search_end_joints = *search_end,
      .search_direction = -problem_.faces[static_cast<std::size_t>(around.face)].plane.outward,
      .search_length_m = heights.approach_m - heights.search_end_m,
      .tilt_rad = pose.tilt_rad,
      .predicted_miss_m = problem_.nominal_miss_m};
}

std::variant<PlannedTouch, std::string> make_touch(const PlanningProblem& problem, const TouchedFace& around,
                                                   const TouchPose& pose, const JointVector& joints) {
  auto touch = TouchMaker(problem).make(around, pose, joints);
  if (const auto* refusal = std::get_if<Refusal>(&touch)) return describe(problem, *refusal);
  return std::get<PlannedTouch>(std::move(touch));
}

}  // namespace calib
