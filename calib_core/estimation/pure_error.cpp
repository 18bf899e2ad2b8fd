#include "calib_core/estimation/pure_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <set>

#include "calib_core/numerics/distributions.hpp"

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

/// Readings within less than that were not made one after the other, and the square of a span must be a
/// number.
constexpr double kSpanMinSeconds = 1e-3;

/// Where the line has its readings: at their times, or one after the other.
std::vector<double> places_of(std::size_t count, std::span<const double> times_s) {
  if (times_s.size() == count && times_s.back() - times_s.front() >= kSpanMinSeconds)
    return {times_s.begin(), times_s.end()};
  std::vector<double> places(count);
  std::iota(places.begin(), places.end(), 0.0);
  return places;
}

}  // namespace

std::vector<std::size_t> counted_indices(std::span<const Touch> at_place) {
  std::set<std::array<std::int64_t, kJointCount>> seen;
  std::vector<std::size_t> once;
  for (std::size_t i = 0; i < at_place.size(); ++i) {
    if (seen.insert(digits_of(at_place[i])).second) once.push_back(i);
  }
  if (2 * once.size() < at_place.size()) return once;
  std::vector<std::size_t> all(at_place.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

std::vector<Touch> counted_readings(std::span<const Touch> at_place) {
  std::vector<Touch> counted;
  for (const std::size_t index : counted_indices(at_place)) counted.push_back(at_place[index]);
  return counted;
}

std::optional<ReadingLine> line_through(std::span<const double> readings_m, std::span<const double> times_s) {
  if (readings_m.size() < kReadingCountMin) return std::nullopt;
  const std::vector<double> places = places_of(readings_m.size(), times_s);
  const double middle = mean(places), mean_m = mean(readings_m);
  double along = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < readings_m.size(); ++i) {
    const double place = places[i] - middle;
    along += place * (readings_m[i] - mean_m);
    spread += place * place;
  }
  ReadingLine line{.slope = along / spread, .span = places.back() - places.front()};
  double squares = 0.0;
  for (std::size_t i = 0; i < readings_m.size(); ++i)
    squares += std::pow(readings_m[i] - mean_m - line.slope * (places[i] - middle), 2);
  const double degrees = static_cast<double>(readings_m.size()) - 2.0;
  line.scatter = {std::sqrt(squares / degrees), degrees};
  line.variance_of_slope = squares / degrees / spread;
  return line;
}

bool is_implausibly_small(const TouchNoise& scatter, double least_m) {
  if (!(scatter.degrees_of_freedom > 0.0)) return false;
  const double squares = scatter.degrees_of_freedom * scatter.std_m * scatter.std_m;
  return squares < least_m * least_m * chi_square_quantile(kScatterDoubtedP, scatter.degrees_of_freedom);
}

TouchNoise pooled(const TouchNoise& first, const TouchNoise& second) {
  const double degrees = first.degrees_of_freedom + second.degrees_of_freedom;
  if (!(degrees > 0.0)) return {};
  const double squares = first.degrees_of_freedom * first.std_m * first.std_m +
                         second.degrees_of_freedom * second.std_m * second.std_m;
  return {std::sqrt(squares / degrees), degrees};
}

}  // namespace calib
