#pragma once

#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_plan.hpp"
#include "calib_core/planning/touch_planning.hpp"

namespace calib {

/// A feasible touch, reduced to what the choice needs; make_touch computes the rest.
struct TouchCandidate {
  int face = 0;
  TouchPose pose;
  JointVector joints;        // the ball touches the nominal face
  JointVector clear_joints;  // transfers end here
};

struct CandidatePool {
  std::vector<TouchCandidate> candidates;  // order determined by the problem and its seed
  std::vector<FaceEffort> efforts;         // one per request
};

/// Finds at least problem.candidate_count feasible touches, distributed evenly over the requests; the share
/// that a face cannot provide goes to the others. The number of tried poses is bounded;
/// FaceEffort::obstructions explains a shortage. Of postures that differ by full turns only the one nearest
/// to the park posture is tried. Throws std::logic_error for a face that does not exist.
CandidatePool find_candidates(const PlanningProblem& problem, const PlanningProgress& progress = {});

}  // namespace calib
