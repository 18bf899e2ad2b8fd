#pragma once

#include <numbers>

/// Unit conversions. touchcal computes in SI units: metres, radians, seconds. Files, the API and messages use
/// millimetres and degrees; only their readers and writers convert.
namespace calib {

inline constexpr double kMetresPerMillimetre = 1e-3;
inline constexpr double kMetresPerMicrometre = 1e-6;
inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

constexpr double metres_from_mm(double mm) { return mm * kMetresPerMillimetre; }
constexpr double mm_from_metres(double m) { return m / kMetresPerMillimetre; }
constexpr double metres_from_um(double um) { return um * kMetresPerMicrometre; }
constexpr double um_from_metres(double m) { return m / kMetresPerMicrometre; }
constexpr double radians_from_degrees(double deg) { return deg * kRadiansPerDegree; }
constexpr double degrees_from_radians(double rad) { return rad / kRadiansPerDegree; }

}  // namespace calib
