#include "calib_core/planning/touch_pose.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace calib {
namespace {

/// How far around a sphere or bore the contact may be from where it is planned; 90 degrees when it may be
/// missed.
double contact_turn_rad(const PlanningProblem& problem, const Face& face) {
  return std::asin(
      std::clamp(problem.nominal_position_error_m / round_contact_radius_m(problem, face), 0.0, 1.0));
}

/// How far the middle of a circle's arc within contact_turn_rad() to either side is from its chord.
double contact_sag_m(const PlanningProblem& problem, const Face& face) {
  return round_contact_radius_m(problem, face) * (1.0 - std::cos(contact_turn_rad(problem, face)));
}

/// A pose whose stylus is tilted by `tilt_rad` from the inward normal, in a direction, and turned about
/// itself. Its origin is to be set.
TouchPose tilted_pose(const Eigen::Vector3d& outward, const Eigen::Vector3d& edge_u, double tilt_rad,
                      double direction_rad, double turn_rad) {
  Eigen::Matrix3d straight;  // z into the face
  straight << edge_u, -outward.cross(edge_u), -outward;
  TouchPose pose{.tilt_rad = tilt_rad};
  pose.block_from_tip.linear() = straight * Eigen::AngleAxisd(direction_rad, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX()) *
                                 Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ());
  return pose;
}

/// As sample_touch_pose(), on the cap of a sphere: all directions of the cap are equally likely but for those
/// on its rim.
TouchPose sample_sphere_pose(const PlanningProblem& problem, const Face& face, UniformChance& chance,
                             double rim_share) {
  const auto on_rim = [&] { return rim_share > 0.0 && chance() < rim_share; };
  const double turn_max_rad = contact_turn_rad(problem, face);
  const double half_angle_rad = std::max(face.cap->half_angle_rad - turn_max_rad, 0.0);
  const double share = on_rim() ? 1.0 : chance();
  const double cosine = 1.0 - share * (1.0 - std::cos(half_angle_rad));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  const double around_rad = chance() * 2.0 * std::numbers::pi;
  const Eigen::Vector3d outward = cosine * face.plane.outward + sine * (std::cos(around_rad) * face.edge_u +
                                                                        std::sin(around_rad) * face.edge_v());
  // Where the ball comes down beside the planned point the stylus leans more against the sphere.
  const double tilt_max_rad = std::clamp(kSphereLeanMaxRadians - turn_max_rad, 0.0, problem.tilt_max_rad);
  const double even_tilt = chance();
  const double tilt_rad = (on_rim() ? std::cbrt(even_tilt) : even_tilt) * tilt_max_rad;
  const double direction_rad = chance() * 2.0 * std::numbers::pi;
  const double turn_rad = chance() * 2.0 * std::numbers::pi;
  TouchPose pose = tilted_pose(outward, outward.unitOrthogonal(), tilt_rad, direction_rad, turn_rad);
  pose.block_from_tip.translation() = face.cap->center_m + round_contact_radius_m(problem, face) * outward;
  return pose;
}

/// As sample_touch_pose(), on the wall of a bore: all its points are equally likely but for those on its
/// rims.
TouchPose sample_bore_pose(const PlanningProblem& problem, const Face& face, UniformChance& chance,
                           double rim_share) {
  const auto place = [&](double half_range) {
    const double even = 2.0 * chance() - 1.0;
    const bool is_on_rim = rim_share > 0.0 && chance() < rim_share;
    return half_range * (is_on_rim ? std::copysign(1.0, even) : even);
  };
  const BoreWall& bore = *face.bore;
  const bool is_all_around = bore.half_angle_rad >= std::numbers::pi;
  const double around_rad = is_all_around
                                ? (2.0 * chance() - 1.0) * std::numbers::pi
                                : place(std::max(bore.half_angle_rad - contact_turn_rad(problem, face), 0.0));
  const double along_m = place(std::max(face.half_extent_m.x() - problem.nominal_position_error_m, 0.0));
  const Eigen::Vector3d outward = Eigen::AngleAxisd(around_rad, bore.axis) * face.plane.outward;
  // The stylus leans over the axis, to either side of the normal.
  const double lean_rad = chance() * kBoreLeanMaxRadians;
  const double aside_rad = (2.0 * chance() - 1.0) * 0.5 * std::numbers::pi;
  const double turn_rad = chance() * 2.0 * std::numbers::pi;
  const Eigen::Vector3d to_side = Eigen::AngleAxisd(aside_rad, bore.axis) * outward;
  const Eigen::Vector3d into = -(std::cos(lean_rad) * bore.axis + std::sin(lean_rad) * to_side);
  const Eigen::Vector3d across = into.unitOrthogonal();
  Eigen::Matrix3d straight;
  straight << across, into.cross(across), into;
  TouchPose pose{.tilt_rad = std::acos(std::clamp(-outward.dot(into), -1.0, 1.0))};
  pose.block_from_tip.linear() = straight * Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ());
  pose.block_from_tip.translation() =
      bore.center_m + along_m * bore.axis - round_contact_radius_m(problem, face) * outward;
  return pose;
}

}  // namespace

double round_contact_radius_m(const PlanningProblem& problem, const Face& face) {
  const double radius_m = surface_of(face).radius_m();
  return face.bore ? radius_m - problem.stylus.radius_m : radius_m + problem.stylus.radius_m;
}

double contact_drop_m(const PlanningProblem& problem, const Face& face) {
  return face.cap ? contact_sag_m(problem, face) : 0.0;
}

double contact_rise_m(const PlanningProblem& problem, const Face& face) {
  return face.bore ? contact_sag_m(problem, face) : 0.0;
}

TouchPose sample_touch_pose(const PlanningProblem& problem, const Face& face, UniformChance& chance,
                            double rim_share) {
  if (face.cap) return sample_sphere_pose(problem, face, chance, rim_share);
  if (face.bore) return sample_bore_pose(problem, face, chance, rim_share);
  const auto on_rim = [&] { return rim_share > 0.0 && chance() < rim_share; };
  const auto along = [&](const Eigen::Vector3d& edge, double half_extent_m) -> Eigen::Vector3d {
    const double even = 2.0 * chance() - 1.0;
    const double place = on_rim() ? std::copysign(1.0, even) : even;
    return place * std::max(half_extent_m - problem.nominal_position_error_m, 0.0) * edge;
  };
  const Eigen::Vector3d& outward = face.plane.outward;
  const Eigen::Vector3d on_u = along(face.edge_u, face.half_extent_m.x());
  const Eigen::Vector3d on_v = along(face.edge_v(), face.half_extent_m.y());
  const double even_tilt = chance();
  const double tilt_rad = (on_rim() ? std::cbrt(even_tilt) : even_tilt) * problem.tilt_max_rad;
  const double direction_rad = chance() * 2.0 * std::numbers::pi;
  const double turn_rad = chance() * 2.0 * std::numbers::pi;

  TouchPose pose = tilted_pose(outward, face.edge_u, tilt_rad, direction_rad, turn_rad);
  // The given centre may lie off the plane; the touched point is on it.
  const Eigen::Vector3d point_m = face.center_m + on_u + on_v;
  pose.block_from_tip.translation() =
      point_m + (problem.stylus.radius_m - signed_distance_m(face.plane, point_m)) * outward;
  return pose;
}

}  // namespace calib
