#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calib_core/geometry/contact_surface.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/kinematics/error_parameters.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// The meaning of a row of the observation matrix.
/// kSignedDistance: the signed distance of the ball centre from the contact plane, metres.
/// kPlaneCoefficients: eq. 6 of the paper, the signed distance divided by minus the plane's distance from the
/// origin. It gives distant planes less weight and is undefined for a plane through the origin and a sphere.
enum class Formulation { kSignedDistance, kPlaneCoefficients };

/// The factor from a signed distance to a row of the formulation.
inline double row_factor(const ContactSurface& plane, Formulation formulation) {
  return formulation == Formulation::kSignedDistance ? 1.0 : -1.0 / plane.offset_m;
}

/// W (n x 37) and Delta Y (n) of eq. 9: W * errors = output_error to first order. Rows follow `touches`,
/// columns follow error_parameters(); metres and radians in, metres out (unit 1 with plane coefficients).
struct Observation {
  Eigen::Matrix<double, Eigen::Dynamic, kErrorParameterCount> matrix;
  Eigen::VectorXd output_error;
};

/// `contact_planes`: one per face, the plane of the ball centre at the trigger.
Observation observe(const KinematicModel& model, std::span<const ContactSurface> contact_planes,
                    std::span<const Touch> touches, Formulation formulation);

/// Divides the row of each touch by its noise_factor(); `touches` are those that were observed.
void weigh_rows(Observation& observation, std::span<const Touch> touches, double declared_noise_m);

/// Signed distance of the ball centre from its contact plane, one per touch; metres.
Eigen::VectorXd signed_distances_m(const KinematicModel& model,
                                   std::span<const ContactSurface> contact_planes,
                                   std::span<const Touch> touches);

/// The touch with the smallest joint displacement (Newton's method) that puts the ball centre of the model on
/// the contact plane. The recorded postures are not on the nominal faces, which makes dependent columns of W
/// look independent.
Touch moved_onto_plane(const PreparedModel& model, const ContactSurface& contact_plane, const Touch& touch);
Touch moved_onto_plane(const KinematicModel& model, const ContactSurface& contact_plane, const Touch& touch);

/// Each of the touches moved onto the plane of its face.
std::vector<Touch> moved_onto_planes(const KinematicModel& model,
                                     std::span<const ContactSurface> contact_planes,
                                     std::vector<Touch> touches);

}  // namespace calib
