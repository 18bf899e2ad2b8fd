#include "calib_core/planning/touch_feasibility.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/internal/bore_room.hpp"

namespace calib {
namespace {

constexpr double kRangeMarginRad = 1.0 * kRadiansPerDegree;
constexpr double kLineStepMetres = 0.010;
constexpr double kSamePlaneMetres = 1e-6;
/// A length of a file is itself within the rounding of what is computed from it.
constexpr double kAsWrittenMetres = 1e-9;
/// What a search begins and ends beyond the position error: the ball is off the face, and the face in reach.
constexpr double kStandoffSpareMetres = 0.003;
/// How often `clear` is moved away from obstacles, and how far from its initial position in total.
constexpr int kClearMovesMax = 4;
constexpr double kClearMoveMaxMetres = 0.100;

/// The largest extent of a box along a direction.
double reach_m(const Box& box, const Eigen::Vector3d& direction) {
  return direction.cwiseProduct(box.min_m).cwiseMax(direction.cwiseProduct(box.max_m)).sum() + box.round_m;
}

/// Whether a body of the probe is above the plane of the touched face; see TouchMaker::make.
bool is_above_plane(const Capsule& body, const Segment& axis, const Plane& plane) {
  const auto end_is_above = [&](const Eigen::Vector3d& end_m, double from_ball_m) {
    return signed_distance_m(plane, end_m) - body.radius_m - body.loose_m >
           kOrientationErrorMaxRadians * from_ball_m - kSamePlaneMetres;
  };
  return end_is_above(axis.from_m, body.from_m.norm()) && end_is_above(axis.to_m, body.to_m.norm());
}

using TipJointRates = Eigen::Matrix<double, kJointCount, 3>;

/// R in q = R v, the joint rates of a tip that moves with v and does not turn: from v = A q1 + B q2 and 0 =
/// C q1 + D q2 (joints 1 to 3 and 4 to 6). Not finite in a singular posture.
TipJointRates tip_joint_rates(const Eigen::Matrix<double, 6, kJointCount>& jacobian) {
  constexpr double kFlat = 1e-6;  // the last three axes of some arms never span the space of turns
  const Eigen::Matrix3d wrist = jacobian.bottomRightCorner<3, 3>();
  if (std::abs(wrist.determinant()) < kFlat) return jacobian.partialPivLu().inverse().leftCols<3>();
  const Eigen::Matrix3d wrist_from_arm = -wrist.inverse() * jacobian.bottomLeftCorner<3, 3>();
  TipJointRates rates;
  rates.topRows<3>() =
      (jacobian.topLeftCorner<3, 3>() + jacobian.topRightCorner<3, 3>() * wrist_from_arm).inverse();
  rates.bottomRows<3>() = wrist_from_arm * rates.topRows<3>();
  return rates;
}

/// Whether a straight motion of the tip needs joints faster than kJointRateMax: the largest singular value of
/// tip_joint_rates().
bool is_singular(const KinematicModel& model, const Chain& chain) {
  const TipJointRates rates = tip_joint_rates(pose_jacobian(model, chain));
  // Below the limit when limit^2 - R^T R is positive definite: tested by its leading minors.
  const Eigen::Matrix3d spare =
      kJointRateMax * kJointRateMax * Eigen::Matrix3d::Identity() - rates.transpose() * rates;
  return !(spare(0, 0) > 0.0 && spare.topLeftCorner<2, 2>().determinant() > 0.0 && spare.determinant() > 0.0);
}

bool is_probe(const Capsule& body) { return body.frame == kFrameCount - 1; }

/// The obstacles behind the plane of a touch of this solid.
std::vector<bool> obstacles_behind(const PlanningProblem& problem, const Plane& plane) {
  std::vector<bool> is_behind;
  for (const Box& obstacle : problem.scene.obstacles)
    is_behind.push_back(reach_m(obstacle, plane.outward) < plane.offset_m + kSamePlaneMetres);
  return is_behind;
}

std::string missed_mm(const PlanningProblem& problem) {
  return std::to_string(std::lround(mm_from_metres(problem.nominal_position_error_m))) + " mm";
}

/// The ball of a sphere among the obstacles, -1 for none.
int find_ball(const PlanningProblem& problem, const Face& sphere) {
  const auto& obstacles = problem.scene.obstacles;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const bool is_there = (obstacles[i].min_m - sphere.cap->center_m).norm() < kSamePlaneMetres &&
                          (obstacles[i].max_m - sphere.cap->center_m).norm() < kSamePlaneMetres;
    if (is_there && std::abs(obstacles[i].round_m - surface_of(sphere).radius_m()) < kSamePlaneMetres)
      return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

std::string describe(const PlanningProblem& problem, const TouchInfeasibility& infeasibility) {
  const auto body = [&](std::size_t index) { return "the " + problem.scene.bodies[index].name; };
  switch (infeasibility.cause) {
    case TouchInfeasibility::Cause::kJointRanges:
      return "joint ranges";
    case TouchInfeasibility::Cause::kSingular:
      return "postures near a singular one";
    case TouchInfeasibility::Cause::kOutOfReach:
      return "out of reach along the search";
    case TouchInfeasibility::Cause::kNearObstacle:
      return body(infeasibility.body) + " is within " + missed_mm(problem) + " of the " +
             problem.scene.obstacles[infeasibility.other].name;
    case TouchInfeasibility::Cause::kHitsItself:
      return body(infeasibility.body) + " hits " + body(infeasibility.other);
    case TouchInfeasibility::Cause::kSmallSphere:
      return "the sphere with the stylus ball is less than twice as wide as the " + missed_mm(problem) +
             " to either side that the arm may miss it by (nominal_miss_mm, more where the block was "
             "located no better)";
    case TouchInfeasibility::Cause::kNarrowBore:
      return "the bore is too narrow for the stylus ball, what the arm may miss by (" + missed_mm(problem) +
             ", nominal_miss_mm, more where the block was located no better) and the "
             "room for an approach: it needs a radius of " +
             std::to_string(std::lround(std::ceil(mm_from_metres(bore_radius_min_m(
                 problem,
                 touch_heights(problem.nominal_position_error_m, problem.standoff_min_m).approach_m))))) +
             " mm";
    case TouchInfeasibility::Cause::kShallowBore:
      return "the depths of the bore that may be touched (depth_mm) are less than twice the " +
             missed_mm(problem) +
             " apart that the arm may miss by (nominal_miss_mm, more where the block was located no better)";
    case TouchInfeasibility::Cause::kNoPath:
      return "no clear way from the park posture";
  }
  throw std::logic_error("describe: no such cause");
}

TouchHeights touch_heights(double nominal_position_error_m, double standoff_min_m) {
  const double standoff_m = std::max(nominal_position_error_m + kStandoffSpareMetres, standoff_min_m);
  return {.approach_m = standoff_m, .clear_m = standoff_m + kSlowZoneMetres, .search_end_m = -standoff_m};
}

double position_error_max_m(double search_length_m) { return search_length_m / 2.0 - kStandoffSpareMetres; }

TouchTarget find_target(const PlanningProblem& problem, int face) {
  const Face& wanted = problem.faces[static_cast<std::size_t>(face)];
  const auto& obstacles = problem.scene.obstacles;
  TouchTarget target{.face = face, .is_behind = std::vector<bool>(obstacles.size(), false)};
  if (!wanted.is_flat()) {
    target.solid = wanted.cap ? find_ball(problem, wanted) : find_bored_solid(problem, wanted);
    if (target.solid >= 0) target.is_behind = obstacles_behind(problem, wanted.plane);
    if (wanted.bore && target.solid >= 0) target.is_behind[static_cast<std::size_t>(target.solid)] = true;
    return target;
  }
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const bool is_side =
        std::abs(reach_m(obstacles[i], wanted.plane.outward) - wanted.plane.offset_m) < kSamePlaneMetres;
    if (is_side && obstacles[i].contains(wanted.center_m, kSamePlaneMetres))
      target.solid = static_cast<int>(i);
  }
  if (target.solid >= 0) target.is_behind = obstacles_behind(problem, wanted.plane);
  return target;
}

TouchMaker::TouchMaker(const PlanningProblem& problem)
    : problem_(problem),
      prepared_(prepare(problem.nominal)),
      inverse_(problem.nominal),
      ranges_(problem.joint_ranges),
      travel_scene_(travel_scene(problem)),
      space_(problem.nominal, travel_scene_, problem.park_joints, problem.nominal_position_error_m) {
  ranges_.lower.array() += kRangeMarginRad;
  ranges_.upper.array() -= kRangeMarginRad;
}

/// The line of one touch, followed in either direction; keeps the reason of a failure.
class TouchMaker::TouchLine {
 public:
  TouchLine(const TouchMaker& maker, const TouchTarget& target, const TouchPose& pose, const Plane& plane,
            const TouchHeights& heights)
      : maker_(maker),
        problem_(maker.problem_),
        target_(target),
        pose_(pose),
        plane_(plane),
        heights_(heights),
        face_(problem_.faces[static_cast<std::size_t>(target.face)]) {}

  /// Follows the normal from the contact posture to a height.
  std::optional<JointVector> follow(const JointVector& contact, double to_m) {
    const int steps = steps_over(to_m);
    JointVector joints = contact;
    for (int step = 1; step <= steps; ++step) {
      const double height_m = to_m * step / steps;
      const auto next = maker_.inverse_.follow(moved(height_m * plane_.outward), joints);
      if (!next) return fail({TouchInfeasibility::Cause::kOutOfReach});
      joints = *next;
      if (!check(joints, height_m)) return std::nullopt;
    }
    return joints;
  }

  /// Leaves the slow zone from the approach posture; there must be a path to park from there.
  std::optional<JointVector> leave(const JointVector& approach) {
    const Eigen::Vector3d straight_m = way_out_m();
    Eigen::Vector3d off_m = straight_m;
    for (int moves = 0; moves <= kClearMovesMax; ++moves) {
      auto clear = maker_.inverse_.follow(moved(off_m), approach);
      if (!clear || !is_in_range(*clear)) break;
      const Eigen::Vector3d away_m = out_of_slow_zone_m(*clear);
      if (away_m.isZero()) {
        const double length_m = (off_m - heights_.approach_m * plane_.outward).norm();
        if (!check_move(approach, *clear, length_m, heights_.approach_m)) return std::nullopt;
        if (!can_reach_park(maker_.space_, *clear)) break;
        return clear;
      }
      off_m += away_m;
      if ((off_m - straight_m).norm() > kClearMoveMaxMetres) break;
    }
    return fail({TouchInfeasibility::Cause::kNoPath});
  }

  bool check(const JointVector& joints, double height_m) {
    infeasibility_ = is_in_range(joints) ? find_infeasibility(joints, height_m)
                                         : TouchInfeasibility{TouchInfeasibility::Cause::kJointRanges};
    return !infeasibility_;
  }

  [[nodiscard]] TouchInfeasibility infeasibility() const { return infeasibility_.value(); }

 private:
  static int steps_over(double length_m) {
    return std::max(static_cast<int>(std::ceil(std::abs(length_m) / kLineStepMetres)), 1);
  }

  [[nodiscard]] Eigen::Isometry3d moved(const Eigen::Vector3d& off_m) const {
    Eigen::Isometry3d block_from_tip = pose_.block_from_tip;
    block_from_tip.translation() += off_m;
    return block_from_tip;
  }

  /// From the contact to `clear`: farther out on the normal, from the approach in a bore out of its mouth.
  [[nodiscard]] Eigen::Vector3d way_out_m() const {
    if (!face_.bore) return heights_.clear_m * plane_.outward;
    const BoreWall& bore = *face_.bore;
    const double depth_m = bore.mouth_m - bore.axis.dot(pose_.block_from_tip.translation() - bore.center_m);
    return heights_.approach_m * plane_.outward + (depth_m + heights_.clear_m) * bore.axis;
  }

  [[nodiscard]] bool is_in_range(const JointVector& joints) const { return maker_.ranges_.contains(joints); }

  std::nullopt_t fail(const TouchInfeasibility& infeasibility) {
    infeasibility_ = infeasibility;
    return std::nullopt;
  }

  /// Checks a straight joint move without its start.
  bool check_move(const JointVector& from, const JointVector& to, double length_m, double height_m) {
    const int steps = steps_over(length_m);
    for (int step = 1; step <= steps; ++step) {
      if (!check(from + (to - from) * step / steps, height_m)) return false;
    }
    return true;
  }

  /// The translation that takes the body deepest in the slow zone out of it; zero when all are outside.
  [[nodiscard]] Eigen::Vector3d out_of_slow_zone_m(const JointVector& joints) const {
    constexpr double kSpareMetres = 1e-4;
    const Chain chain = forward_chain(maker_.prepared_, joints);
    double missing_m = 0.0;
    Eigen::Vector3d away = Eigen::Vector3d::Zero();
    for (const Capsule& body : maker_.travel_scene_.bodies) {
      if (!is_probe(body)) continue;
      const Segment axis = axis_in_block(body, chain);
      const double own_m = body.radius_m + body.margin_m + problem_.nominal_position_error_m;
      for (const Box& obstacle : problem_.scene.obstacles) {
        if (is_apart(axis, obstacle, own_m + missing_m)) continue;
        const double needed_m = own_m + obstacle.round_m;
        const Eigen::Vector3d gap_m = segment_box_gap_m(axis, obstacle);
        if (needed_m - gap_m.norm() <= missing_m) continue;
        missing_m = needed_m - gap_m.norm();
        away = gap_m.normalized();
      }
    }
    return missing_m > 0.0 ? Eigen::Vector3d((missing_m + kSpareMetres) * away) : Eigen::Vector3d::Zero();
  }

  [[nodiscard]] std::optional<TouchInfeasibility> find_infeasibility(const JointVector& joints,
                                                                     double height_m) const {
    const Chain chain = forward_chain(maker_.prepared_, joints);
    if (is_singular(problem_.nominal, chain)) return TouchInfeasibility{TouchInfeasibility::Cause::kSingular};
    const auto& bodies = problem_.scene.bodies;
    std::vector<Segment> axes;
    axes.reserve(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      axes.push_back(axis_in_block(bodies[i], chain));
      if (const auto obstacle = find_obstacle(bodies[i], axes[i], height_m)) {
        return TouchInfeasibility{TouchInfeasibility::Cause::kNearObstacle, i, *obstacle};
      }
    }
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (are_neighbours(bodies[i], bodies[j])) continue;
        const double apart_m = bodies[i].radius_m + bodies[j].radius_m + kSelfClearanceMetres;
        if (!is_apart(axes[i], axes[j], apart_m))
          return TouchInfeasibility{TouchInfeasibility::Cause::kHitsItself, i, j};
      }
    }
    return std::nullopt;
  }

  /// The first obstacle that a body is too close to.
  [[nodiscard]] std::optional<std::size_t> find_obstacle(const Capsule& body, const Segment& axis,
                                                         double height_m) const {
    const auto& obstacles = problem_.scene.obstacles;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      if (height_m < 0.0 && target_.is_behind[i]) continue;
      if (is_apart(axis, obstacles[i], body.radius_m + body.margin_m + problem_.nominal_position_error_m))
        continue;
      const bool exempt = is_probe(body) && target_.is_behind[i];
      if (exempt && stays_off(body, axis, i, height_m)) continue;
      return i;
    }
    return std::nullopt;
  }

  /// Whether a body of the probe stays off the obstacle that is touched, or one behind it, until the contact.
  [[nodiscard]] bool stays_off(const Capsule& body, const Segment& axis, std::size_t obstacle,
                               double height_m) const {
    if (!face_.bore || static_cast<int>(obstacle) != target_.solid) return is_above_plane(body, axis, plane_);
    // At the approach and on the way in there is a wall on the other side as well.
    if (height_m > heights_.approach_m - kSamePlaneMetres) return false;
    const Eigen::Vector3d ball_m = pose_.block_from_tip.translation() + height_m * plane_.outward;
    return stays_off_wall(problem_, face_, problem_.scene.obstacles[obstacle], body, axis, ball_m);
  }

  const TouchMaker& maker_;
  const PlanningProblem& problem_;
  const TouchTarget& target_;
  const TouchPose& pose_;
  const Plane& plane_;  // of the face; of a sphere or bore, that which touches it at the contact
  const TouchHeights heights_;
  const Face& face_;
  std::optional<TouchInfeasibility> infeasibility_;
};

std::variant<PlannedTouch, TouchInfeasibility> TouchMaker::make(const TouchTarget& target,
                                                                const TouchPose& pose,
                                                                const JointVector& joints) const {
  const Face& face = problem_.faces[static_cast<std::size_t>(target.face)];
  if (face.cap && round_contact_radius_m(problem_, face) < 2.0 * problem_.nominal_position_error_m)
    return TouchInfeasibility{TouchInfeasibility::Cause::kSmallSphere};
  TouchHeights heights = touch_heights(problem_.nominal_position_error_m, problem_.standoff_min_m);
  if (face.bore &&
      surface_of(face).radius_m() < bore_radius_min_m(problem_, heights.approach_m) - kAsWrittenMetres)
    return TouchInfeasibility{TouchInfeasibility::Cause::kNarrowBore};
  if (face.bore && face.half_extent_m.x() < problem_.nominal_position_error_m - kAsWrittenMetres)
    return TouchInfeasibility{TouchInfeasibility::Cause::kShallowBore};
  heights.search_end_m -= contact_drop_m(problem_, face);
  heights.approach_m += contact_rise_m(problem_, face);
  heights.clear_m += contact_rise_m(problem_, face);
  const Plane plane = tangent_plane(surface_of(face), pose.block_from_tip.translation());
  TouchTarget here = target;
  if (!face.is_flat() && target.solid >= 0) here.is_behind = obstacles_behind(problem_, plane);
  if (face.bore && target.solid >= 0) here.is_behind[static_cast<std::size_t>(target.solid)] = true;
  TouchLine line(*this, here, pose, plane, heights);
  if (!line.check(joints, 0.0)) return line.infeasibility();
  const auto approach = line.follow(joints, heights.approach_m);
  if (!approach) return line.infeasibility();
  const auto search_end = line.follow(joints, heights.search_end_m);
  if (!search_end) return line.infeasibility();
  const auto clear = line.leave(*approach);
  if (!clear) return line.infeasibility();
  return PlannedTouch{.face = target.face,
                      .joints = joints,
                      .clear_joints = *clear,
                      .approach_joints = *approach,
                      .search_end_joints = *search_end,
                      .search_direction = -plane.outward,
                      .search_length_m = heights.approach_m - heights.search_end_m,
                      .tilt_rad = pose.tilt_rad,
                      .predicted_position_error_m = problem_.nominal_position_error_m};
}

std::variant<PlannedTouch, std::string> make_touch(const PlanningProblem& problem, const TouchTarget& target,
                                                   const TouchPose& pose, const JointVector& joints) {
  auto touch = TouchMaker(problem).make(target, pose, joints);
  if (const auto* infeasibility = std::get_if<TouchInfeasibility>(&touch))
    return describe(problem, *infeasibility);
  return std::get<PlannedTouch>(std::move(touch));
}

}  // namespace calib
