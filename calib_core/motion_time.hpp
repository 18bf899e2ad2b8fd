#pragma once

#include "calib_core/joint_vector.hpp"

namespace calib {

/// How fast a cell's arm moves: what a predicted time needs to know.
struct MotionLimits {
  JointVector joint_speeds_max = JointVector::Ones();  // rad/s
  double travel_m_s = 0.25;                            // caps of the tool centre's speed
  double approach_m_s = 0.02;
  double search_m_s = 0.008;
  double second_m_s = 0.0;  // of the second, slow touch; 0 for none
  double second_backoff_m = 0.0;
};

}  // namespace calib
