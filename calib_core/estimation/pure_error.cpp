#include "calib_core/estimation/pure_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>

namespace calib {
namespace {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Finer than an encoder of a robot's joint reads (1e-5 degrees), in rad or m.
constexpr double kSameReading = 1.7e-7;

std::array<std::int64_t, kJointCount> digits_of(const Touch& touch) {
  std::array<std::int64_t, kJointCount> digits{};
  std::ranges::transform(touch.joints, digits.begin(), [](double joint) {
    return static_cast<std::int64_t>(std::llround(joint / kSameReading));
  });
  return digits;
}

}  // namespace

std::vector<Touch> counted_readings(std::span<const Touch> at_place) {
  std::set<std::array<std::int64_t, kJointCount>> seen;
  std::vector<Touch> once;
  for (const Touch& touch : at_place) {
    if (seen.insert(digits_of(touch)).second) once.push_back(touch);
  }
  if (2 * once.size() < at_place.size()) return once;
  return {at_place.begin(), at_place.end()};
}

std::optional<ReadingLine> line_through(std::span<const double> readings_m) {
  if (readings_m.size() < kReadingCountMin) return std::nullopt;
  const auto count = static_cast<double>(readings_m.size());
  const double middle = (count - 1.0) / 2.0;
  const double mean_m = mean(readings_m);
  double along = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < readings_m.size(); ++i) {
    const double place = static_cast<double>(i) - middle;
    along += place * (readings_m[i] - mean_m);
    spread += place * place;
  }
  ReadingLine line{.slope = along / spread};
  double squares = 0.0;
  for (std::size_t i = 0; i < readings_m.size(); ++i)
    squares += std::pow(readings_m[i] - mean_m - line.slope * (static_cast<double>(i) - middle), 2);
  const double degrees = count - 2.0;
  line.scatter = {std::sqrt(squares / degrees), degrees};
  line.variance_of_slope = squares / degrees / spread;
  return line;
}

TouchNoise pooled(const TouchNoise& first, const TouchNoise& second) {
  const double degrees = first.degrees_of_freedom + second.degrees_of_freedom;
  if (!(degrees > 0.0)) return {};
  const double squares = first.degrees_of_freedom * first.std_m * first.std_m +
                         second.degrees_of_freedom * second.std_m * second.std_m;
  return {std::sqrt(squares / degrees), degrees};
}

}  // namespace calib
