#include "calib_core/planning/internal/bore_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_pose.hpp"

namespace calib {
namespace {

constexpr double kSameBoreMetres = 1e-6;
/// Directions in which the rim of the ball's places is looked at; between them it bulges by half a percent.
constexpr int kDirections = 32;

/// Places of the ball's centre across the axis that all others lie between: those on the circle of the
/// position error about where it should be, as far as they are inside the wall, and those on the wall within
/// that circle.
std::vector<Eigen::Vector3d> outermost_places_m(const Hole& hole, const Eigen::Vector3d& ball_off_m,
                                                double contact_radius_m, double error_m) {
  const Eigen::Vector3d u = hole.axis.unitOrthogonal(), v = hole.axis.cross(u);
  std::vector<Eigen::Vector3d> places_m;
  for (int i = 0; i < kDirections; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / kDirections;
    const Eigen::Vector3d way = std::cos(angle_rad) * u + std::sin(angle_rad) * v;
    const Eigen::Vector3d beside_m = ball_off_m + error_m * way;
    if (beside_m.norm() <= contact_radius_m) places_m.push_back(beside_m);
    const Eigen::Vector3d on_wall_m = contact_radius_m * way;
    if ((on_wall_m - ball_off_m).norm() <= error_m) places_m.push_back(on_wall_m);
  }
  return places_m;
}

}  // namespace

int find_bored_solid(const PlanningProblem& problem, const Face& bore) {
  const double radius_m = surface_of(bore).radius_m();
  const auto& obstacles = problem.scene.obstacles;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const bool is_there = std::ranges::any_of(obstacles[i].holes, [&](const Hole& hole) {
      return hole.off_axis_m(bore.bore->center_m).norm() < kSameBoreMetres &&
             std::abs(hole.radius_m - radius_m) < kSameBoreMetres;
    });
    if (is_there) return static_cast<int>(i);
  }
  return -1;
}

double bore_radius_min_m(const PlanningProblem& problem, double standoff_m) {
  const double error_m = problem.nominal_position_error_m;
  // At the approach the ball is off the touched wall by the standoff and what the wall comes towards it by,
  // and off the other one by the error: 2 c >= standoff + c - sqrt(c^2 - e^2) + e for the contact radius c.
  // It holds wherever 2 c >= standoff + 2 e.
  const double contact_radius_m = std::max(2.0 * error_m, 0.5 * standoff_m + error_m);
  return contact_radius_m + problem.stylus.radius_m;
}

bool stays_off_wall(const PlanningProblem& problem, const Face& bore, const Box& solid, const Capsule& body,
                    const Segment& axis, const Eigen::Vector3d& ball_m) {
  const double radius_m = surface_of(bore).radius_m();
  const Hole hole{bore.bore->center_m, bore.bore->axis, radius_m};
  const double error_m = problem.nominal_position_error_m;
  const Part part = part_near(axis, solid, body.radius_m + body.margin_m + error_m);
  if (part.is_empty()) return true;
  const Eigen::Vector3d ball_off_m = hole.off_axis_m(ball_m);
  const auto places_m = outermost_places_m(hole, ball_off_m, round_contact_radius_m(problem, bore), error_m);
  // What is looked at is convex along the body and over the places of the ball: it is largest at their ends.
  return std::ranges::all_of(std::array{part.from, part.to}, [&](double share) {
    const Eigen::Vector3d point_m = axis.from_m + share * (axis.to_m - axis.from_m);
    const Eigen::Vector3d beside_m = hole.off_axis_m(point_m) - ball_off_m;
    const double needed_m = body.radius_m + kOrientationErrorMaxRadians * (point_m - ball_m).norm();
    return std::ranges::all_of(places_m, [&](const Eigen::Vector3d& place_m) {
      return (place_m + beside_m).norm() + needed_m < radius_m + kSameBoreMetres;
    });
  });
}

}  // namespace calib
