#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "calib_core/geometry/face.hpp"
#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/touch.hpp"
#include "calib_core/identification/identify.hpp"
#include "calib_core/kinematics/kinematic_model.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/motion/motion_time.hpp"
#include "calib_core/motion/transfer_path.hpp"

namespace calib {

/// One touch to make. Approach, search end and clear posture keep the orientation that `joints` has; the
/// first two lie on the face's outward normal through the touched point, the last where TouchMaker puts it.
struct PlannedTouch {
  int face = 0;
  TouchRole role = TouchRole::kFit;
  JointVector joints;                // the aiming model's ball touches the nominal face
  JointVector clear_joints;          // well off the face: transfers begin and end here
  JointVector approach_joints;       // standoff: the search begins and the retract ends here
  JointVector search_end_joints;     // where a search that met nothing ends
  Eigen::Vector3d search_direction;  // unit, in R_-1: into the face
  double search_length_m = 0.0;
  double tilt_rad = 0.0;  // stylus axis to inward normal
  /// 3 sigma of where the ball is when its turn comes, or at the touch before or behind if that is more, so
  /// that both ways can keep it; sizes clearance and search.
  double predicted_miss_m = 0.0;
  std::vector<JointVector> via;  // way to clear_joints from the touch before (the park posture at first)
  double travel_s = 0.0;         // predicted time of that way
  double touch_s = 0.0;          // ... and of the touch, from clear_joints and back
};

/// Touches wanted on a face.
struct TouchRequest {
  int face = 0;
  int fit_min = 0;
  int fit_max = 0;
  int held_out_count = 0;
};

/// What the touches that are fitted are chosen for.
enum class PlanCriterion {
  kTipInBox,          // smallest predicted tip error over the workspace box
  kTipInJointRanges,  // ... over the joint ranges
  kInformation,       // largest determinant of the information (D-optimality)
  kConditionNumber,   // smallest condition number of the identifiable columns, metres and radians
};

struct PlanGoal {
  PlanCriterion criterion = PlanCriterion::kTipInBox;
  int fit_count = 0;  // touches to fit, over all faces; at most so many when an accuracy is wanted
  /// The fewest touches whose predicted tip error is within this, root mean square over the criterion's
  /// region (the workspace box for those that have none).
  std::optional<double> tip_rms_max_m;
};

struct PlanningProblem {
  KinematicModel nominal;  // the model that aims
  JointRanges joint_ranges;
  std::vector<Face> faces;
  Stylus stylus;
  CollisionScene scene;
  std::vector<TouchRequest> requests;
  PlanGoal goal;
  JointVector park_joints;        // where a run begins and ends; free of obstacles
  double nominal_miss_m = 0.012;  // how far the arm may miss: sizes clearance and search
  /// A search begins at least so far before its face and ends so far behind it. Less once touches aim.
  double standoff_min_m = 0.015;
  double tilt_max_rad = 0.0;
  std::uint64_t seed = 1;        // of the candidates; the same problem gives the same plan
  int candidate_count = 20'000;  // touches that can be made, to choose from
  /// What the touches will be identified with: artefact, noise, tolerances; without touches. Its `nominal` is
  /// that of the arm's file.
  IdentificationProblem knowledge;
  IdentificationOptions identification;
  Box workspace_box;
  MotionLimits motion;
};

/// One reason why touches could not be made, and how many of those tried it stopped.
struct Obstruction {
  std::string reason;  // "joint ranges", "the forearm is within 12 mm of the table"
  int count = 0;
};

/// What was tried for a face.
struct FaceEffort {
  int face = 0;
  int tried = 0;                          // postures
  int feasible = 0;                       // of them
  std::vector<Obstruction> obstructions;  // most frequent first
};

struct TouchPlan {
  std::vector<PlannedTouch> touches;  // in the order they are made: planes interleaved, fit before held-out
  std::vector<JointVector> park_via;  // way from the last touch to the park posture
  double park_s = 0.0;                // its predicted time
  std::vector<FaceEffort> efforts;    // one a request

  /// Predicted time from the park posture and back, seconds.
  [[nodiscard]] double duration_s() const;
};

/// Nothing can be planned: what was tried, the best that can be had, what stands in the way.
struct PlanningFailure {
  enum class Kind { kPark, kFace, kAccuracy, kPlanes };
  Kind kind = Kind::kFace;
  int face = 0;   // kFace: the first with too few touches
  int found = 0;  // touches that can be made there
  int wanted = 0;
  std::optional<double> best_tip_rms_m;  // kAccuracy: with all touches that were allowed
  std::string reason;                    // one sentence
  std::vector<FaceEffort> efforts;       // as far as it came
};

/// Told as planning goes on: what is done now and the share of all that is done, 0 to 1.
using PlanningProgress = std::function<void(std::string_view stage, double share)>;

/// Anything that may be touched has a zone this wide around it in which the probe (all bodies of frame 7, and
/// the tip) goes at approach speed: travel stays out of it, also with an arm that is off by the nominal miss.
inline constexpr double kSlowZoneMetres = 0.025;

/// The problem's scene with the margins that travel between touches keeps.
CollisionScene travel_scene(const PlanningProblem& problem);

/// Finds postures for the touches asked for (see touch_candidate.hpp for what a touch must keep clear of),
/// takes those that tell most of the kinematic errors (fit) and others apart from them (held out), and puts
/// them in an order that shows all parameters early and then travels little. Any touch can follow any other:
/// see find_transfer. Throws std::logic_error for a face that does not exist.
std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem,
                                                      const PlanningProgress& progress = {});

/// Joint postures that lead from `from` to `to` in straight joint moves, neither end included, all clear of
/// the scene by the nominal miss; nothing when no way is found. Empty when the direct move is clear. At most
/// kTransferPosturesMax. See find_way.
std::optional<std::vector<JointVector>> find_transfer(const PlanningProblem& problem, const JointVector& from,
                                                      const JointVector& to);

}  // namespace calib
