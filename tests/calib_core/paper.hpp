#pragma once

#include <vector>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

/// Hage, Bidaud, Jardin (2011), written out once for the tests of the core.
namespace calib::paper {

/// Table I.
KinematicModel nominal();

/// Table III, metres and radians.
ErrorVector table3();

/// Table II as planes with outward normals; the tip is the contact point.
std::vector<ContactSurface> planes();

/// The column order of tests/data/table3-exact.expected.json: these are moved to the end.
std::vector<int> tried_last();

}  // namespace calib::paper
