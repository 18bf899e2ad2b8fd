#include "calib_core/kinematics/nongeometric_parameters.hpp"

#include <stdexcept>

namespace calib {
namespace {

std::array<NongeometricParameter, kNongeometricCount> list_nongeometric() {
  std::array<NongeometricParameter, kNongeometricCount> parameters;
  const auto at = [&](int position) -> NongeometricParameter& {
    return parameters[static_cast<std::size_t>(position)];
  };
  for (int joint = 0; joint < kJointCount; ++joint) {
    at(compliance_position(joint)) = {NongeometricKind::kCompliance, joint + 1};
    at(harmonic_position(joint)) = {NongeometricKind::kHarmonicCos, joint + 1};
    at(harmonic_position(joint) + 1) = {NongeometricKind::kHarmonicSin, joint + 1};
    at(second_harmonic_position(joint)) = {NongeometricKind::kSecondCos, joint + 1};
    at(second_harmonic_position(joint) + 1) = {NongeometricKind::kSecondSin, joint + 1};
    at(ripple_position(joint)) = {NongeometricKind::kRippleCos, joint + 1};
    at(ripple_position(joint) + 1) = {NongeometricKind::kRippleSin, joint + 1};
  }
  for (int frame = 1; frame <= kMassCount; ++frame)
    at(mass_position(frame)) = {NongeometricKind::kMass, frame};
  return parameters;
}

}  // namespace

std::string NongeometricParameter::name() const {
  switch (kind) {
    case NongeometricKind::kCompliance:
      return "compliance" + std::to_string(number);
    case NongeometricKind::kHarmonicCos:
      return "harmonic_cos" + std::to_string(number);
    case NongeometricKind::kHarmonicSin:
      return "harmonic_sin" + std::to_string(number);
    case NongeometricKind::kMass:
      return "mass" + std::to_string(number);
    case NongeometricKind::kSecondCos:
      return "second_harmonic_cos" + std::to_string(number);
    case NongeometricKind::kSecondSin:
      return "second_harmonic_sin" + std::to_string(number);
    case NongeometricKind::kRippleCos:
      return "ripple_cos" + std::to_string(number);
    case NongeometricKind::kRippleSin:
      return "ripple_sin" + std::to_string(number);
  }
  throw std::logic_error("NongeometricParameter: no such kind");
}

std::string NongeometricParameter::unit() const {
  switch (kind) {
    case NongeometricKind::kCompliance:
      return "rad/Nm";
    case NongeometricKind::kHarmonicCos:
    case NongeometricKind::kHarmonicSin:
    case NongeometricKind::kSecondCos:
    case NongeometricKind::kSecondSin:
    case NongeometricKind::kRippleCos:
    case NongeometricKind::kRippleSin:
      return "rad";
    case NongeometricKind::kMass:
      return "1";
  }
  throw std::logic_error("NongeometricParameter: no such kind");
}

const std::array<NongeometricParameter, kNongeometricCount>& nongeometric_parameters() {
  static const auto parameters = list_nongeometric();
  return parameters;
}

std::vector<int> estimable_compliances(const NongeometricDeviations& std) {
  constexpr int kJointsBeforeWrist = 3;
  std::vector<int> positions;
  for (int joint = 0; joint < kJointsBeforeWrist; ++joint) {
    if (std[static_cast<std::size_t>(compliance_position(joint))])
      positions.push_back(compliance_position(joint));
  }
  return positions;
}

}  // namespace calib
