#pragma once

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// What a touch is for. kFit: identification. kHeldOut: validation, never fitted. kProof: on another artefact
/// or at another place, never fitted.
enum class TouchRole { kFit, kHeldOut, kProof };

/// One contact: the joints latched at the trigger and the face that was touched.
struct Touch {
  int face = 0;  // index of the face; see face_name()
  JointVector joints = JointVector::Zero();
  TouchRole role = TouchRole::kFit;
  /// Standard deviation of this touch along the normal, metres; 0: that of any touch, the declared noise.
  double deviation_m = 0.0;
};

/// The deviations that a touch may have of its own: below is rounding, above is no touch.
inline constexpr double kTouchDeviationMinMetres = 1e-9;
inline constexpr double kTouchDeviationMaxMetres = 5e-3;

/// The deviation of a touch in units of the declared noise, metres: 1 unless it has one of its own. A row of
/// the observation is divided by it, so that what follows from the rows is in units of the declared noise.
inline double noise_factor(const Touch& touch, double declared_m) {
  return touch.deviation_m == 0.0 ? 1.0 : touch.deviation_m / declared_m;
}

}  // namespace calib
