#pragma once

#include <array>

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// Element i of the van der Corput sequence, in (0, 1) for i > 0.
inline double van_der_corput(int i, int base) {
  double value = 0.0, digit = 1.0 / base;
  for (; i > 0; i /= base, digit /= base) value += (i % base) * digit;
  return value;
}

/// Posture i, counted from 1, of a quasi-random sequence that fills the joint ranges evenly: Halton, On the
/// efficiency of certain quasi-random sequences of points in evaluating multi-dimensional integrals (1960).
inline JointVector halton_posture(int i, const JointRanges& ranges) {
  constexpr std::array<int, kJointCount> kBases{2, 3, 5, 7, 11, 13};
  JointVector joints;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double share = van_der_corput(i, kBases[static_cast<std::size_t>(joint)]);
    joints[joint] = ranges.lower[joint] + share * (ranges.upper[joint] - ranges.lower[joint]);
  }
  return joints;
}

}  // namespace calib
