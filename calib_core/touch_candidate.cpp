#include "calib_core/touch_candidate.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "calib_core/inverse_kinematics.hpp"
#include "calib_core/transfer.hpp"
#include "calib_core/units.hpp"

namespace calib {
namespace {

constexpr double kRangeMarginRad = 1.0 * kRadiansPerDegree;
constexpr double kLineStepMetres = 0.010;
constexpr double kSamePlaneMetres = 1e-6;

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

std::string describe(const std::string& body, const std::string& obstacle, double clearance_m) {
  return "the " + body + " is within " + std::to_string(std::lround(mm_from_metres(clearance_m))) +
         " mm of the " + obstacle;
}

/// Why the arm cannot be here in a touch; empty when it can.
std::string find_trouble(const PlanningProblem& problem, const TouchedFace& around, const Chain& chain,
                         double height_m) {
  const Plane& plane = problem.faces[static_cast<std::size_t>(around.face)].plane;
  for (const Capsule& body : problem.scene.bodies) {
    const Segment placed = place(body, chain);
    for (std::size_t i = 0; i < problem.scene.obstacles.size(); ++i) {
      if (height_m < 0.0 && around.is_behind[i]) continue;
      const Box& obstacle = problem.scene.obstacles[i];
      const double apart_m = segment_box_distance_m(placed, obstacle) - body.radius_m;
      if (apart_m >= problem.nominal_miss_m + body.margin_m) continue;
      const bool may_be_near = body.frame == kFrameCount - 1 && around.is_behind[i];
      if (may_be_near && is_over_face(body, placed, plane)) continue;
      return describe(body.name, obstacle.name, problem.nominal_miss_m);
    }
  }
  const CollisionScene arm_alone{.bodies = problem.scene.bodies};
  const auto clash = find_clash(arm_alone, chain, kSelfClearanceMetres);
  return clash ? "the " + clash->body + " hits the " + clash->other : "";
}

bool is_singular(const KinematicModel& model, const Chain& chain) {
  const Eigen::Matrix<double, 6, 6> joints_from_pose = pose_jacobian(model, chain).inverse();
  const Eigen::Matrix3d rates = joints_from_pose.leftCols<3>().transpose() * joints_from_pose.leftCols<3>();
  const double fastest =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(rates, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  return !(fastest < kJointRateMax * kJointRateMax);
}

/// Follows the touch's line in either direction and keeps what was wrong.
class LineOfTouch {
 public:
  LineOfTouch(const PlanningProblem& problem, const TouchedFace& around, const TouchPose& pose)
      : problem_(problem), around_(around), pose_(pose) {}

  /// From the last height to this one, in steps; nothing when the touch cannot be made, see trouble().
  std::optional<JointVector> follow(const JointVector& start, double from_m, double to_m) {
    const auto steps = std::max<long>(std::lround(std::ceil(std::abs(to_m - from_m) / kLineStepMetres)), 1);
    JointVector joints = start;
    for (long step = 1; step <= steps; ++step) {
      const double height_m =
          from_m + (to_m - from_m) * static_cast<double>(step) / static_cast<double>(steps);
      Eigen::Isometry3d block_from_tip = pose_.block_from_tip;
      block_from_tip.pretranslate(height_m * face().plane.outward);
      const auto next = solve_near(problem_.nominal, block_from_tip, joints);
      if (!next) {
        trouble_ = "out of reach along the search";
        return std::nullopt;
      }
      joints = *next;
      if (!check(joints, height_m)) return std::nullopt;
    }
    return joints;
  }

  bool check(const JointVector& joints, double height_m) {
    const Chain chain = forward_chain(problem_.nominal, joints);
    const JointVector margin = JointVector::Constant(kRangeMarginRad);
    if (!JointRanges{problem_.joint_ranges.lower + margin, problem_.joint_ranges.upper - margin}.contains(
            joints)) {
      trouble_ = "joint ranges";
    } else if (is_singular(problem_.nominal, chain)) {
      trouble_ = "postures near a singular one";
    } else {
      trouble_ = find_trouble(problem_, around_, chain, height_m);
    }
    return trouble_.empty();
  }

  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] const Face& face() const { return problem_.faces[static_cast<std::size_t>(around_.face)]; }

 private:
  const PlanningProblem& problem_;
  const TouchedFace& around_;
  const TouchPose& pose_;
  std::string trouble_;
};

}  // namespace

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

std::variant<PlannedTouch, std::string> make_touch(const PlanningProblem& problem, const TouchedFace& around,
                                                   const TouchPose& pose, const JointVector& joints) {
  const TouchHeights heights = touch_heights(problem.nominal_miss_m, problem.standoff_min_m);
  LineOfTouch line(problem, around, pose);
  if (!line.check(joints, 0.0)) return line.trouble();
  const auto approach = line.follow(joints, 0.0, heights.approach_m);
  if (!approach) return line.trouble();
  const auto clear = line.follow(*approach, heights.approach_m, heights.clear_m);
  if (!clear) return line.trouble();
  const auto search_end = line.follow(joints, 0.0, heights.search_end_m);
  if (!search_end) return line.trouble();
  const CollisionScene scene = travel_scene(problem);
  if (!is_near_park({problem.nominal, scene, problem.park_joints, problem.nominal_miss_m}, *clear)) {
    return "no clear way from the park posture";
  }
  return PlannedTouch{.face = around.face,
                      .joints = joints,
                      .clear_joints = *clear,
                      .approach_joints = *approach,
                      .search_end_joints = *search_end,
                      .search_direction = -line.face().plane.outward,
                      .search_length_m = heights.approach_m - heights.search_end_m,
                      .tilt_rad = pose.tilt_rad,
                      .predicted_miss_m = problem.nominal_miss_m};
}

}  // namespace calib
