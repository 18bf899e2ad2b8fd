#pragma once

#include <optional>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/online_estimate.hpp"

namespace cell {

/// The place that a run touches again and again, always in the same way, to see whether anything moves. It is
/// that of the first touch that is fitted. Not a touch of the plan: it is neither counted nor fitted.
struct ReferencePlace {
  calib::PlannedTouch planned;
  calib::JointVector first_joints;              // of the plan's own touch there
  std::optional<calib::AimedTouch> aimed;       // how it is made
  std::optional<calib::JointVector> reference;  // its first contact, which drift counts from
  int count = 0;                                // contacts there
  int made_at = -1;                             // touches done when the last one was made
  double drift_m = 0.0;                         // of the last one
  double allowed_drift_m = 0.0;                 // what a person has let pass
  bool due = false;  // whatever is done: a daemon that was started anew looks again
};

/// The last touch, which the others contradict, until it is known what to think of it.
struct Misfit {
  calib::AimedTouch aimed;          // it is made again in the same way
  calib::OnlineArmEstimate before;  // what was known without it
};

}  // namespace cell
