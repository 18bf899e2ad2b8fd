#pragma once

#include <Eigen/Geometry>

#include "calib_core/geometry/face.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/planning/planning_problem.hpp"

namespace calib {

/// Pose of R_7 when the ball touches a face, and the angle of its z axis to the inward normal of the face.
struct TouchPose {
  Eigen::Isometry3d block_from_tip;
  double tilt_rad = 0.0;
};

/// A random pose, all quantities uniformly distributed: a point at least the nominal position error inside
/// the rectangle of the face, a tilt from 0 to the limit in any direction, a rotation about the stylus. The
/// fraction `rim_share` of the points is on the rim along either edge, and of the tilts closer to the limit:
/// such touches determine the errors best. On the cap of a sphere the point is as far inside its rim that
/// the contact is on the cap wherever the arm may be, and the tilt is limited by kSphereLeanMaxRadians. In a
/// bore the stylus stands along the axis, its end outside the mouth leaning up to kBoreLeanMaxRadians away
/// from the touched side; tilt_max_rad does not hold there, as the ball is pushed from the side.
TouchPose sample_touch_pose(const PlanningProblem& problem, const Face& face, UniformChance& chance,
                            double rim_share = 0.0);

/// Largest angle between the stylus and the inward normal of a sphere where an inaccurate arm may touch it:
/// its shaft stays clear of the sphere.
inline constexpr double kSphereLeanMaxRadians = 1.3;

/// Largest angle between the stylus and the axis of a bore.
inline constexpr double kBoreLeanMaxRadians = 0.5;

/// The distance of the stylus ball's centre, in contact, from the centre of a sphere or the axis of a bore.
double round_contact_radius_m(const PlanningProblem& problem, const Face& face);

/// How much farther along the planned line than on a plane the contact may be: on a sphere the ball of an
/// inaccurate arm may come down beside the planned point. 0 on a plane and in a bore.
double contact_drop_m(const PlanningProblem& problem, const Face& face);

/// How much earlier along the planned line than on a plane the contact may be: in a bore the wall comes
/// towards the ball of an inaccurate arm, beside the planned point. 0 elsewhere.
double contact_rise_m(const PlanningProblem& problem, const Face& face);

}  // namespace calib
