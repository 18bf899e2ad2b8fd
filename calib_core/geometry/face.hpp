#pragma once

#include <Eigen/Geometry>

#include "calib_core/geometry/plane.hpp"

namespace calib {

/// One flat of the artefact: its plane and the rectangle of it that may be touched, in R_-1.
struct Face {
  Plane plane;
  Eigen::Vector3d center_m;
  Eigen::Vector3d edge_u;         // unit vector in the face; edge_v() is outward x edge_u
  Eigen::Vector2d half_extent_m;  // along edge_u and edge_v

  [[nodiscard]] Eigen::Vector3d edge_v() const { return plane.outward.cross(edge_u); }
};

/// The ball that touches. A tip that is itself the contact point has radius 0 and pre-travel 0.
struct Stylus {
  double radius_m = 0.0;
  double pretravel_m = 0.0;  // how far the ball's undeflected centre goes on after contact until the trigger
};

/// Where the ball's undeflected centre P is at the trigger: outward . P = offset + radius - pretravel.
inline Plane contact_plane(const Face& face, const Stylus& stylus) {
  return {face.plane.outward, face.plane.offset_m + stylus.radius_m - stylus.pretravel_m};
}

}  // namespace calib
