#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"

namespace calib {

/// What an arm does beside rigid kinematics, as errors that can be estimated or that widen the uncertainty.
enum class NongeometricKind {
  kCompliance,   // of a joint under the torque of gravity, rad/Nm
  kHarmonicCos,  // of a joint's transmission: amplitude * cos(position), rad; an eccentric last gear
  kHarmonicSin,  // the same with the sine
  kMass,         // of what moves with a frame: error as a share of the mass
  kSecondCos,    // of a joint's transmission: amplitude * cos(2 position), rad; an oval gear
  kSecondSin,    // the same with the sine
  kRippleCos,    // of a joint's gear: amplitude * cos(periods a turn * position), rad
  kRippleSin     // the same with the sine
};

struct NongeometricParameter {
  NongeometricKind kind = NongeometricKind::kCompliance;
  int number = 1;  // of the joint, 1 to 6; of the frame for a mass, 1 to 7

  [[nodiscard]] std::string name() const;  // "compliance2", "harmonic_cos3", "mass4", "second_harmonic_cos3"
  [[nodiscard]] std::string unit() const;  // "rad/Nm", "rad", "1"
};

inline constexpr int kMassCount = 7;
inline constexpr int kNongeometricCount = 7 * kJointCount + kMassCount;

/// Positions in the list: compliances of joints 1 to 6, cosine and sine of joint 1, of joint 2 ..., masses of
/// frames 1 to 7, cosine and sine of the second harmonic of joint 1, of joint 2 ..., of the ripple likewise.
constexpr int compliance_position(int joint) { return joint; }                  // joint: index, 0 to 5
constexpr int harmonic_position(int joint) { return kJointCount + 2 * joint; }  // of the cosine
constexpr int mass_position(int frame) { return 3 * kJointCount + frame - 1; }
constexpr int second_harmonic_position(int joint) {  // of the cosine
  return 3 * kJointCount + kMassCount + 2 * joint;
}
constexpr int ripple_position(int joint) {  // of the cosine
  return 5 * kJointCount + kMassCount + 2 * joint;
}
constexpr bool is_harmonic(int position) {
  return position >= harmonic_position(0) && position < mass_position(1);
}
constexpr bool is_second_harmonic(int position) {
  return position >= second_harmonic_position(0) && position < ripple_position(0);
}
constexpr bool is_ripple(int position) { return position >= ripple_position(0); }

const std::array<NongeometricParameter, kNongeometricCount>& nongeometric_parameters();

/// Standard deviation of each before any touch; nothing where it is unknown or the effect is not modelled. Of
/// a ripple only where its period is known: it is that of the cosine and of the sine, 1/sqrt(2) of the
/// amplitude, and as long as it is not estimated the gears' errors of posture count it.
using NongeometricDeviations = std::array<std::optional<double>, kNongeometricCount>;

/// Positions of the compliances that touches show: of joints 1 to 3, where they have a standard deviation.
/// The wrist carries too little.
std::vector<int> estimable_compliances(const NongeometricDeviations& std);

}  // namespace calib
