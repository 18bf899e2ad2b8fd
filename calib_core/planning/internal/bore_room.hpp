#pragma once

#include <Eigen/Core>
#include <optional>

#include "calib_core/geometry/face.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/planning/planning_problem.hpp"

namespace calib {

/// The obstacle that a bore is a hole of, -1 for none.
int find_bored_solid(const PlanningProblem& problem, const Face& bore);

/// The radius below which an inaccurate arm has no room in a bore: to either side of a contact that it may
/// miss by the nominal position error the wall is still in front of the ball, and at the height of the
/// approach the ball is clear of the wall behind it.
double bore_radius_min_m(const PlanningProblem& problem, double standoff_m);

/// Whether a body of the probe stays off the wall of the bore until the ball meets it, wherever the ball is
/// within the nominal position error of `ball_m`: as far as it is inside the solid, and by
/// kOrientationErrorMaxRadians times its distance from the ball. Where this holds it need not keep the
/// position error to the wall, as the contact ends the search. The ball itself meets the wall and fulfils it.
bool stays_off_wall(const PlanningProblem& problem, const Face& bore, const Box& solid, const Capsule& body,
                    const Segment& axis, const Eigen::Vector3d& ball_m);

}  // namespace calib
