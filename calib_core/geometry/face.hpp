#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/plane.hpp"

namespace calib {

/// The part of a ball's surface that may be touched: the directions from its centre within an angle of the
/// pole's.
struct SphereCap {
  Eigen::Vector3d center_m;  // of the sphere
  double half_angle_rad = 0.0;
};

/// One face of the artefact in R_-1: a flat, its plane and the rectangle of it that may be touched; or a cap
/// of a sphere, with its tangent plane at the pole and the square around the cap as seen from there.
struct Face {
  Plane plane;
  Eigen::Vector3d center_m;       // in the plane; the pole of a cap
  Eigen::Vector3d edge_u;         // unit vector in the face; edge_v() is outward x edge_u
  Eigen::Vector2d half_extent_m;  // along edge_u and edge_v
  std::optional<SphereCap> cap = std::nullopt;

  [[nodiscard]] Eigen::Vector3d edge_v() const { return plane.outward.cross(edge_u); }
};

/// The cap of a sphere as a face. `pole`: unit vector from the centre to the middle of the cap.
inline Face sphere_face(const Eigen::Vector3d& center_m, double radius_m, const Eigen::Vector3d& pole,
                        double half_angle_rad) {
  const double half_extent_m = radius_m * std::sin(std::min(half_angle_rad, std::numbers::pi / 2.0));
  return {.plane = {pole, pole.dot(center_m) + radius_m},
          .center_m = center_m + radius_m * pole,
          .edge_u = pole.unitOrthogonal(),
          .half_extent_m = {half_extent_m, half_extent_m},
          .cap = SphereCap{center_m, half_angle_rad}};
}

/// The surface of the material.
inline ContactSurface surface_of(const Face& face) {
  return {face.plane.outward, face.plane.offset_m,
          face.cap ? std::optional(face.cap->center_m) : std::nullopt};
}

/// The name of a face in messages: "plane 1" for index 0. Files, the API and the page call a face a plane and
/// count from 1.
inline std::string face_name(std::size_t index) { return "plane " + std::to_string(index + 1); }

/// The ball that touches. A tip that is itself the contact point has radius 0 and pre-travel 0.
struct Stylus {
  double radius_m = 0.0;
  double pretravel_m = 0.0;  // travel of the undeflected ball centre from contact to trigger
};

/// Where the undeflected ball centre P is at the trigger: outward . P = offset + radius - pretravel on a
/// plane, that far outside a sphere.
inline ContactSurface contact_plane(const Face& face, const Stylus& stylus) {
  ContactSurface surface = surface_of(face);
  surface.offset_m += stylus.radius_m - stylus.pretravel_m;
  return surface;
}

}  // namespace calib
