#pragma once

#include <Eigen/Core>
#include <span>

#include "calib_core/geometry/plane.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// What a row of the observation matrix is.
/// kSignedDistance: the signed distance of the ball's centre from the contact plane, metres.
/// kPlaneCoefficients: eq. 6 of the paper, the same divided by minus the plane's distance from the origin, so
/// it weighs far planes less and has no form for a plane through the origin.
enum class Formulation { kSignedDistance, kPlaneCoefficients };

/// W (n x 37) and Delta Y (n) of eq. 9: W * errors = output_error to first order. Rows follow `touches`,
/// columns follow error_parameters(); metres and radians in, metres out (1 with plane coefficients).
struct Observation {
  Eigen::Matrix<double, Eigen::Dynamic, kErrorParameterCount> matrix;
  Eigen::VectorXd output_error;
};

/// `contact_planes` has one entry a face, where the ball's centre is at the trigger.
Observation observe(const KinematicModel& model, std::span<const Plane> contact_planes,
                    std::span<const Touch> touches, Formulation formulation);

/// Signed distance of the ball's centre from its contact plane, one a touch; metres.
Eigen::VectorXd signed_distances_m(const KinematicModel& model, std::span<const Plane> contact_planes,
                                   std::span<const Touch> touches);

/// The touch moved by the smallest joint displacement (Newton) so that the model's ball centre lies on the
/// contact plane. The recorded postures are off the nominal faces, which makes dependent columns look
/// independent.
Touch moved_onto_plane(const PreparedModel& model, const Plane& contact_plane, const Touch& touch);
Touch moved_onto_plane(const KinematicModel& model, const Plane& contact_plane, const Touch& touch);

}  // namespace calib
