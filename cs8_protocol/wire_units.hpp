#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

/// Wire units of the protocol, here and nowhere else: 10^-6 degree, 10^-4 mm, um/s.
namespace cs8 {

inline std::int32_t microdeg_from_radians(double rad) {
  return static_cast<std::int32_t>(std::lround(rad * (180.0e6 / std::numbers::pi)));
}
/// By way of degrees, as files give them: a touch read back from a file is the one that came over the wire,
/// to the bit.
constexpr double radians_from_microdeg(std::int32_t microdeg) {
  return microdeg / 1e6 * (std::numbers::pi / 180.0);
}

/// The six joints of a message from radians; `Joints` is a vector of six numbers that takes an int as its
/// index.
template <class Joints>
std::array<std::int32_t, 6> microdeg_from_joints(const Joints& rad) {
  std::array<std::int32_t, 6> microdeg{};
  for (int i = 0; i < 6; ++i) microdeg[static_cast<std::size_t>(i)] = microdeg_from_radians(rad[i]);
  return microdeg;
}
template <class Joints>
Joints joints_from_microdeg(const std::array<std::int32_t, 6>& microdeg) {
  Joints rad;
  for (int i = 0; i < 6; ++i) rad[i] = radians_from_microdeg(microdeg[static_cast<std::size_t>(i)]);
  return rad;
}

inline std::int32_t dmm_from_metres(double m) { return static_cast<std::int32_t>(std::lround(m * 1e7)); }
constexpr double metres_from_dmm(std::int32_t dmm) { return dmm * 1e-7; }

inline std::int32_t um_s_from_metres_per_second(double m_s) {
  return static_cast<std::int32_t>(std::lround(m_s * 1e6));
}
constexpr double metres_per_second_from_um_s(std::int32_t um_s) { return um_s * 1e-6; }

}  // namespace cs8
