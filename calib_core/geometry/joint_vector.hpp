#pragma once

#include <Eigen/Core>

namespace calib {

inline constexpr int kJointCount = 6;

/// Six joint positions as the controller reports them, joint 1 first; radians (metres for a prismatic joint).
using JointVector = Eigen::Matrix<double, kJointCount, 1>;

/// Joint limits, both ends included; units as in JointVector.
struct JointRanges {
  JointVector lower;
  JointVector upper;

  [[nodiscard]] bool contains(const JointVector& joints) const {
    return (joints.array() >= lower.array()).all() && (joints.array() <= upper.array()).all();
  }
};

}  // namespace calib
