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
};

}  // namespace calib
