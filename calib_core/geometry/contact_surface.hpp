#pragma once

#include <Eigen/Core>
#include <optional>

#include "calib_core/geometry/plane.hpp"

namespace calib {

/// A surface in R_-1 that the centre of a touching ball can lie on: a plane, or a sphere where a centre is
/// given. A sphere is written by its tangent plane in one direction and its centre, so that more offset is
/// more material in either case; its radius is offset_m - outward . center.
struct ContactSurface {
  Eigen::Vector3d outward;  // unit vector; of a sphere, that of its pole: the middle of what may be touched
  double offset_m = 0.0;    // outward . X of the plane, or of the sphere's pole
  std::optional<Eigen::Vector3d> center_m = std::nullopt;  // of a sphere

  [[nodiscard]] bool is_sphere() const { return center_m.has_value(); }
  /// Of a sphere.
  [[nodiscard]] double radius_m() const { return offset_m - outward.dot(*center_m); }
};

/// Metres from the surface, positive outside the material.
inline double signed_distance_m(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  if (!surface.center_m) return surface.outward.dot(point_m) - surface.offset_m;
  return (point_m - *surface.center_m).norm() - surface.radius_m();
}

/// Unit vector out of the material where the surface is nearest to the point: d distance / d point. At the
/// very centre of a sphere, that of its pole.
inline Eigen::Vector3d normal_at(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  if (!surface.center_m) return surface.outward;
  const Eigen::Vector3d from_center_m = point_m - *surface.center_m;
  const double length_m = from_center_m.norm();
  return length_m > 0.0 ? Eigen::Vector3d(from_center_m / length_m) : surface.outward;
}

/// The plane that touches the surface where it is nearest to the point.
inline Plane tangent_plane(const ContactSurface& surface, const Eigen::Vector3d& point_m) {
  if (!surface.center_m) return {surface.outward, surface.offset_m};
  const Eigen::Vector3d normal = normal_at(surface, point_m);
  return {normal, normal.dot(*surface.center_m) + surface.radius_m()};
}

}  // namespace calib
