#pragma once

#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_planning.hpp"

namespace calib {

/// A touch that can be made, as far as choosing needs it; make_touch gives the whole of it.
struct TouchCandidate {
  int face = 0;
  TouchPose pose;
  JointVector joints;        // the ball touches the nominal face
  JointVector clear_joints;  // where transfers to it end
};

struct CandidatePool {
  std::vector<TouchCandidate> candidates;  // in an order that only the problem and its seed decide
  std::vector<FaceEffort> efforts;         // one a request
};

/// Touches that make_touch can make, at least problem.candidate_count of them, shared evenly over the
/// requests; what a face cannot have the others get. A face that has few or none has its effort say what
/// stood in the way: at most a bounded number of poses is tried. Of postures that differ by whole turns only
/// the one nearest to the park posture is tried. Throws std::logic_error for a face that does not exist.
CandidatePool find_candidates(const PlanningProblem& problem, const PlanningProgress& progress = {});

}  // namespace calib
