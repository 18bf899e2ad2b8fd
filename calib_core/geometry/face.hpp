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

/// The part of the wall of a bore that may be touched: as deep as the face's half extent along edge_u says to
/// either side of its middle, and within an angle about the axis.
struct BoreWall {
  Eigen::Vector3d center_m;     // on the axis, in the middle of the depths that may be touched
  Eigen::Vector3d axis;         // unit vector, out of the mouth
  double mouth_m = 0.0;         // from center_m along the axis to the mouth
  double half_angle_rad = 0.0;  // to either side of the middle; pi is all around
};

/// One face of the artefact in R_-1: a flat, its plane and the rectangle of it that may be touched; a cap of
/// a sphere, with its tangent plane at the pole and the square around the cap as seen from there; or a part
/// of the wall of a bore, with its tangent plane in the middle and edge_u along the axis.
struct Face {
  Plane plane;
  Eigen::Vector3d center_m;       // in the plane; the pole of a cap, the middle of a wall
  Eigen::Vector3d edge_u;         // unit vector in the face; edge_v() is outward x edge_u
  Eigen::Vector2d half_extent_m;  // along edge_u and edge_v
  std::optional<SphereCap> cap = std::nullopt;
  std::optional<BoreWall> bore = std::nullopt;

  [[nodiscard]] bool is_flat() const { return !cap && !bore; }
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

/// The wall of a bore as a face. `wall_middle`: unit vector from the axis to the middle of what may be
/// touched, perpendicular to the axis.
inline Face bore_face(const BoreWall& wall, double radius_m, const Eigen::Vector3d& wall_middle,
                      double half_depth_m) {
  const double half_extent_m = radius_m * std::sin(std::min(wall.half_angle_rad, std::numbers::pi / 2.0));
  return {.plane = {-wall_middle, -wall_middle.dot(wall.center_m) - radius_m},
          .center_m = wall.center_m + radius_m * wall_middle,
          .edge_u = wall.axis,
          .half_extent_m = {half_depth_m, half_extent_m},
          .bore = wall};
}

/// The surface of the material.
inline ContactSurface surface_of(const Face& face) {
  ContactSurface surface{face.plane.outward, face.plane.offset_m};
  if (face.cap) surface.center_m = face.cap->center_m;
  if (face.bore) {
    surface.center_m = face.bore->center_m;
    surface.axis = face.bore->axis;
  }
  return surface;
}

/// The name of a face in messages: "plane 1" for index 0. Files, the API and the page call a face a plane and
/// count from 1.
inline std::string face_name(std::size_t index) { return "plane " + std::to_string(index + 1); }

/// The ball that touches. A tip that is itself the contact point has radius 0 and pre-travel 0.
struct Stylus {
  double radius_m = 0.0;
  double pretravel_m = 0.0;         // travel of the undeflected ball centre from contact to trigger
  SidewaysPretravel sideways = {};  // what a push from the side adds to it
};

/// Where the undeflected ball centre P is at the trigger: outward . P = offset + radius - pretravel on a
/// plane, that far outside a sphere, that far inside the wall of a bore. For a push along the stylus; the
/// surface knows what others add.
inline ContactSurface contact_plane(const Face& face, const Stylus& stylus) {
  ContactSurface surface = surface_of(face);
  surface.offset_m += stylus.radius_m - stylus.pretravel_m;
  surface.sideways = stylus.sideways;
  return surface;
}

}  // namespace calib
