#pragma once

#include <string>
#include <variant>

#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"

namespace calib {

/// A touch computed with the current estimate of the arm, and the problem it was computed with: model and
/// bound on the position error by which its approach, its search and a path to the park posture are clear.
struct AimedTouch {
  PlannedTouch touch;
  PlanningProblem problem;
};

/// The planned touch at the same point of its face and in the same orientation, computed with the estimate;
/// its approach, search and clear posture are sized by the predicted position error. While the nominal arm is
/// as accurate as the estimate, it is nominal_touch(). Or a short text: why it is infeasible.
std::variant<AimedTouch, std::string> aim_touch(const PlanningProblem& problem,
                                                const OnlineArmEstimate& estimate,
                                                const PlannedTouch& planned);

/// The planned touch computed with the nominal arm and the nominal position error.
std::variant<AimedTouch, std::string> nominal_touch(const PlanningProblem& problem,
                                                    const PlannedTouch& planned);

}  // namespace calib
