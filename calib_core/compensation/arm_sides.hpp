#pragma once

#include "calib_core/kinematics/kinematic_model.hpp"

namespace calib {

/// Which way an arm of six revolute joints is folded, by its own geometry: it cannot leave a side without
/// passing a posture in which it loses a direction.
struct ArmSides {
  bool ahead = true;           // the end of the forearm lies before the axis of joint 1
  bool elbow_positive = true;  // elbow_rad is not negative
  bool wrist_positive = true;  // wrist_rad is not negative

  bool operator==(const ArmSides&) const = default;
};

/// Angles that say how near an arm is to losing a direction; radians, -pi to pi.
struct ArmBend {
  ArmSides sides;
  double elbow_rad = 0.0;  // of the forearm against the upper arm, about joint 3; 0 stretched, pi folded
  double wrist_rad = 0.0;  // of the axis of joint 6 against that of joint 4, about joint 5; 0 straight

  /// Distance of each angle from the nearest posture in which the arm loses a direction, 0 to pi / 2.
  [[nodiscard]] double elbow_margin_rad() const;
  [[nodiscard]] double wrist_margin_rad() const;
};

/// Of the chain of a rigid arm. The upper arm runs from the axis of joint 2 to that of joint 3, the forearm
/// from there to the origin of R_4 (the wrist's centre, or a point of the axis of joint 4 where that one is
/// parallel to joint 3), both as seen along the axis of joint 3. On a TX90 the two angles are joints 3 and 5,
/// and the sides are the shoulder, elbow and wrist of a VAL3 `config`. An arm without an upper arm or a
/// forearm has an elbow of a quarter turn.
ArmBend arm_bend(const Chain& chain);

}  // namespace calib
