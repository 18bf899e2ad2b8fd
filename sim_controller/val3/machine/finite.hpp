#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <type_traits>

#include "sim_controller/val3/machine/run_error.hpp"
#include "sim_controller/val3/program/values.hpp"

namespace val3 {

/// Whether all numbers in a value are numbers, and none is beyond its format; true of a value without any.
template <class T>
bool is_finite(const T& value) {
  const auto all = [](std::initializer_list<double> numbers) {
    return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
  };
  if constexpr (std::is_same_v<T, double>) return std::isfinite(value);
  if constexpr (std::is_same_v<T, Joint> || std::is_same_v<T, JointRs>)
    return std::ranges::all_of(value, [](double axis) { return std::isfinite(axis); });
  if constexpr (std::is_same_v<T, Trsf>)
    return all({value.x, value.y, value.z, value.rx, value.ry, value.rz});
  if constexpr (std::is_same_v<T, Point> || std::is_same_v<T, Frame>) return is_finite(value.trsf);
  if constexpr (std::is_same_v<T, Mdesc>)
    return all({value.accel, value.vel, value.decel, value.tvel, value.rvel, value.leave, value.reach});
  return true;
}

/// The value, or RunFailure 11. No manual says what a number too large for its format is. A program that went
/// on with it would wait, or move, without end.
template <class T>
T demand_finite(T value) {
  if (!is_finite(value)) throw RunFailure(kErrorArgument, "a result that is too large for a number");
  return value;
}

}  // namespace val3
