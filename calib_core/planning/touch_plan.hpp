#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/geometry/touch.hpp"

namespace calib {

/// One planned touch. Approach, search end and clear posture have the orientation of `joints`; the first two
/// lie on the outward normal of the face through the touched point. See TouchMaker for the clear posture.
struct PlannedTouch {
  int face = 0;
  TouchRole role = TouchRole::kFit;
  JointVector joints;                // the ball touches the nominal face, by the model of the plan
  JointVector clear_joints;          // off the face: transfers begin and end here
  JointVector approach_joints;       // the search begins and the retract ends here
  JointVector search_end_joints;     // a search without a contact ends here
  Eigen::Vector3d search_direction;  // unit vector into the face, in R_-1 of its place
  double search_length_m = 0.0;
  double tilt_rad = 0.0;  // stylus axis, of a further tip its stem, to inward normal
  /// 3 sigma of the ball position when this touch is made, at least that of the previous and the next touch
  /// (both transfers have to keep it). Sizes clearance and search.
  double predicted_position_error_m = 0.0;
  std::vector<JointVector> via;  // transfer to clear_joints from the previous touch (first: from park)
  double travel_s = 0.0;         // predicted time of the transfer
  double touch_s = 0.0;          // predicted time of the touch, from clear_joints and back
};

/// One reason why touches are infeasible, and the number of rejected postures.
struct Obstruction {
  std::string reason;  // "joint ranges", "the forearm is within 12 mm of the table"
  int count = 0;
};

/// Statistics of the search for candidates on a face.
struct FaceEffort {
  int face = 0;
  int tried = 0;                          // postures
  int feasible = 0;                       // of them
  std::vector<Obstruction> obstructions;  // most frequent first
};

/// The way to the park posture behind the last touch at a place: there the arm waits until the artefact
/// stands at the next one.
struct LeavingPlace {
  std::size_t touches = 0;       // of the plan, made before it
  std::vector<JointVector> via;  // transfer from the last of them
  double travel_s = 0.0;
};

struct TouchPlan {
  /// In execution order: place by place; at each the faces interleaved, fitted before held-out.
  std::vector<PlannedTouch> touches;
  std::vector<LeavingPlace> leaving;  // one between each two places
  std::vector<JointVector> park_via;  // transfer from the last touch to the park posture
  double park_s = 0.0;                // its predicted time
  std::vector<FaceEffort> efforts;    // one per request

  /// Predicted time from the park posture and back, seconds; without what a person needs to move the
  /// artefact.
  [[nodiscard]] double duration_s() const {
    double sum = park_s;
    for (const PlannedTouch& touch : touches) sum += touch.travel_s + touch.touch_s;
    for (const LeavingPlace& place : leaving) sum += place.travel_s;
    return sum;
  }
};

/// Why there is no plan.
struct PlanningFailure {
  enum class Kind { kPark, kFace, kAccuracy, kUnidentifiable };
  Kind kind = Kind::kFace;
  int face = 0;   // kFace: the first with too few feasible touches
  int found = 0;  // feasible touches there
  int wanted = 0;
  std::optional<double> best_tip_rms_m;  // kAccuracy: with all allowed touches
  std::string reason;                    // one sentence
  std::vector<FaceEffort> efforts;       // as far as planning came
};

}  // namespace calib
