#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/collision.hpp"
#include "calib_core/face.hpp"
#include "calib_core/joint_vector.hpp"
#include "calib_core/kinematic_model.hpp"
#include "calib_core/touch.hpp"
#include "calib_core/transfer.hpp"

namespace calib {

/// One touch to make. Approach, search end and clear posture keep the orientation that `joints` has; they lie
/// on the face's outward normal through the touched point.
struct PlannedTouch {
  int face = 0;
  TouchRole role = TouchRole::kFit;
  JointVector joints;                // the nominal arm's ball touches the nominal face
  JointVector clear_joints;          // well off the face: transfers begin and end here
  JointVector approach_joints;       // standoff: the search begins and the retract ends here
  JointVector search_end_joints;     // where a search that met nothing ends
  Eigen::Vector3d search_direction;  // unit, in R_-1: into the face
  double search_length_m = 0.0;
  double tilt_rad = 0.0;  // stylus axis to inward normal
};

struct TouchRequest {
  int face = 0;
  int fit_count = 0;
  int held_out_count = 0;
};

struct PlanningProblem {
  KinematicModel nominal;
  JointRanges joint_ranges;
  std::vector<Face> faces;
  Stylus stylus;
  CollisionScene scene;
  std::vector<TouchRequest> requests;
  JointVector park_joints;        // where a run begins and ends; free of obstacles
  double nominal_miss_m = 0.012;  // how far the uncalibrated arm may miss: sizes clearance and search
  double tilt_max_rad = 0.0;
  std::uint64_t seed = 1;  // of the candidates; the same problem gives the same plan
};

struct TouchPlan {
  std::vector<PlannedTouch> touches;  // in the order they are made: planes interleaved, fit before held-out
};

/// Nothing can be planned: which face, how many of how many, and what stood in the way most often.
struct PlanningFailure {
  int face = 0;
  int found = 0;
  int wanted = 0;
  std::string reason;
};

/// Anything that may be touched has a zone this wide around it in which the probe (all bodies of frame 7, and
/// the tip) goes at approach speed: travel stays out of it, also with an arm that is off by the nominal miss.
inline constexpr double kSlowZoneMetres = 0.025;

/// The problem's scene with the margins that travel between touches keeps.
CollisionScene travel_scene(const PlanningProblem& problem);

/// Finds postures for the touches asked for (see touch_candidate.hpp for what a touch must keep clear of),
/// takes those that tell most of the kinematic errors (fit) and others apart from them (held out), and puts
/// them in an order that shows all parameters early and then travels little. Any touch can follow any other:
/// see find_transfer. A failure names the first face with too few touches, or says that the park
/// posture is not clear. Throws std::logic_error for a face
/// that does not exist.
std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem);

/// Joint postures that lead from `from` to `to` in straight joint moves, neither end included, all clear of
/// the scene by the nominal miss; nothing when no way is found. Empty when the direct move is clear. At most
/// kTransferPosturesMax. See find_way.
std::optional<std::vector<JointVector>> find_transfer(const PlanningProblem& problem, const JointVector& from,
                                                      const JointVector& to);

}  // namespace calib
