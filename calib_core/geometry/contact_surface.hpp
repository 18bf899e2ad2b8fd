#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>

#include "calib_core/geometry/plane.hpp"
#include "calib_core/geometry/sideways_pretravel.hpp"

namespace calib {

/// A surface in R_-1 that the centre of a touching ball can lie on: a plane; a sphere where a centre is
/// given; the inside of a cylinder, a bore, where a centre and an axis are. All are written so that more
/// offset is more material.
///
/// A sphere is written by its tangent plane in one direction and its centre; its radius is offset_m -
/// outward . center. A bore is written by the plane that touches its wall and a point on its axis; `outward`
/// points out of the material, from the wall to the axis, so that its radius is outward . center - offset_m.
/// The ball is inside: its centre lies at the radius of the bore less that of the ball plus the pre-travel
/// from the axis at the trigger, and a larger offset makes that radius smaller.
struct ContactSurface {
  Eigen::Vector3d outward;  // unit vector; of a sphere or bore, in the middle of what may be touched
  double offset_m = 0.0;    // outward . X of the plane, or of the tangent plane there
  std::optional<Eigen::Vector3d> center_m = std::nullopt;  // of a sphere; a point on the axis of a bore
  std::optional<Eigen::Vector3d> axis = std::nullopt;      // of a bore: unit vector, perpendicular to outward
  SidewaysPretravel sideways = {};                         // how much deeper a tilted stylus comes
  /// The centre of the ball that it is of, in R_7; see ArtefactTip.
  Eigen::Vector3d ball_m = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_flat() const { return !center_m.has_value(); }
  [[nodiscard]] bool is_sphere() const { return center_m.has_value() && !axis.has_value(); }
  [[nodiscard]] bool is_bore() const { return axis.has_value(); }
  /// Of a sphere or bore.
  [[nodiscard]] double radius_m() const {
    const double to_tangent_m = offset_m - outward.dot(*center_m);
    return axis ? -to_tangent_m : to_tangent_m;
  }
};

/// From the centre of a sphere or the axis of a bore to the point.
inline Eigen::Vector3d from_middle_m(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  Eigen::Vector3d from_m = point_m - *surface.center_m;
  if (surface.axis) from_m -= surface.axis->dot(from_m) * *surface.axis;
  return from_m;
}

/// Metres from the surface, positive outside the material; of a ball that is pushed along its stylus.
inline double signed_distance_m(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  if (surface.is_flat()) return surface.outward.dot(point_m) - surface.offset_m;
  const double outside_m = from_middle_m(surface, point_m).norm() - surface.radius_m();
  return surface.is_bore() ? -outside_m : outside_m;
}

/// Unit vector out of the material where the surface is nearest to the point: d distance / d point; of a
/// bore, towards its axis. At the very centre of a sphere or on the axis of a bore, `outward`.
inline Eigen::Vector3d normal_at(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  if (surface.is_flat()) return surface.outward;
  const Eigen::Vector3d from_m = from_middle_m(surface, point_m);
  const double length_m = from_m.norm();
  if (!(length_m > 0.0)) return surface.outward;
  return from_m / (surface.is_bore() ? -length_m : length_m);
}

/// Where the surface's ball is in this pose of R_7.
inline Eigen::Vector3d ball_at_m(const ContactSurface& surface, const Eigen::Isometry3d& block_from_tip) {
  return block_from_tip * surface.ball_m;
}

inline Eigen::Vector3d normal_at(const ContactSurface& surface, const Eigen::Isometry3d& block_from_tip) {
  return normal_at(surface, ball_at_m(surface, block_from_tip));
}

/// Where a ball meets a surface.
struct BallContact {
  Eigen::Vector3d ball_m;  // its centre, in R_-1
  Eigen::Vector3d normal;  // of the surface there
  Eigen::Vector3d push;    // the same in R_7
};
inline BallContact contact_at(const ContactSurface& surface, const Eigen::Isometry3d& block_from_tip) {
  BallContact contact{.ball_m = ball_at_m(surface, block_from_tip), .normal = {}, .push = {}};
  contact.normal = normal_at(surface, contact.ball_m);
  contact.push = block_from_tip.linear().transpose() * contact.normal;
  return contact;
}

/// Of a touch: metres by which the ball in this pose of R_7 is outside of where it trips. The material pushes
/// along the normal; what the direction of that push about the stylus adds to the pre-travel is in it.
inline double signed_distance_m(const ContactSurface& surface, const Eigen::Isometry3d& block_from_tip) {
  const Eigen::Vector3d ball_m = ball_at_m(surface, block_from_tip);
  const double distance_m = signed_distance_m(surface, ball_m);
  if (surface.sideways.is_zero()) return distance_m;
  return distance_m + surface.sideways.at(block_from_tip.linear().transpose() * normal_at(surface, ball_m));
}

/// The plane that touches the surface where it is nearest to the point.
inline Plane tangent_plane(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  if (surface.is_flat()) return {surface.outward, surface.offset_m};
  const Eigen::Vector3d normal = normal_at(surface, point_m);
  const double radius_m = surface.radius_m();
  return {normal, normal.dot(*surface.center_m) + (surface.is_bore() ? -radius_m : radius_m)};
}

}  // namespace calib
