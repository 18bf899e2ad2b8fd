#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>

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

/// The name of a face in messages: "plane 1" for index 0. Files, the API and the page call a face a plane and
/// count from 1.
inline std::string face_name(std::size_t index) { return "plane " + std::to_string(index + 1); }

/// The ball that touches. A tip that is itself the contact point has radius 0 and pre-travel 0.
struct Stylus {
  double radius_m = 0.0;
  double pretravel_m = 0.0;  // travel of the undeflected ball centre from contact to trigger
};

/// The plane of the undeflected ball centre P at the trigger: outward . P = offset + radius - pretravel.
inline Plane contact_plane(const Face& face, const Stylus& stylus) {
  return {face.plane.outward, face.plane.offset_m + stylus.radius_m - stylus.pretravel_m};
}

}  // namespace calib
