#pragma once

#include <Eigen/Core>

#include "calib_core/geometry/joint_vector.hpp"
#include "cs8_protocol/messages.hpp"
#include "service/base/json_figures.hpp"

/// Points, boxes and joints as every document writes them.
namespace calib {
struct Box;
}

namespace cell {

/// [x, y, z] in millimetres.
Json vector_mm_json(const Eigen::Vector3d& vector_m);

/// name, min_mm, max_mm.
Json box_json(const calib::Box& box);  // of a rounded one the box around it

/// Six angles in degrees; those of the wire without a rounding.
Json joints_deg_json(const calib::JointVector& joints_rad);
Json joints_deg_json(const cs8::JointsMicrodeg& joints);

}  // namespace cell
