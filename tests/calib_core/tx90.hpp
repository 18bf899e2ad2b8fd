#pragma once

#include <vector>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/motion/collision.hpp"
#include "tests/calib_core/paper.hpp"

/// The arm, its bodies and its surroundings as the planning tests need them; the model is paper::nominal().
namespace calib::tx90 {

JointVector degrees(double j1, double j2, double j3, double j4, double j5, double j6);

/// The maker's ranges.
JointRanges joint_ranges();

JointVector park_joints();

/// Radii are assumed (no drawing); the segments follow from Table I.
std::vector<Capsule> arm_bodies();

/// Tool holder, probe and stylus; with a ball only if the tip is not the contact point itself.
std::vector<Capsule> probe_bodies(double ball_radius_m);

std::vector<Box> obstacles();

CollisionScene scene(double ball_radius_m);

/// The block's four faces (Table II) and the top of the plate it stands on.
std::vector<Face> faces();

}  // namespace calib::tx90
