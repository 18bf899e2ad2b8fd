#pragma once

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// fit: identifies; held_out: validates, never fitted; proof: on another artefact or place, never fitted.
enum class TouchRole { kFit, kHeldOut, kProof };

/// One contact: the joints latched at the trigger and the face they were captured on.
struct Touch {
  int face = 0;  // index into the block's faces; people and files count planes from 1
  JointVector joints = JointVector::Zero();
  TouchRole role = TouchRole::kFit;
};

}  // namespace calib
