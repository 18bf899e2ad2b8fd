#include "service/run/reference_drift.hpp"

#include <cmath>

#include "calib_core/numerics/distributions.hpp"

namespace cell {
namespace {

constexpr double kConfidence = 0.997;

}  // namespace

ReferencePlace reference_place(const std::vector<double>& readings_m, std::span<const double> times_s) {
  const auto line = calib::line_through(readings_m, times_s);
  if (!line) return {};
  ReferencePlace place{.scatter = line->scatter};
  place.open_trend = {line->span * std::sqrt(line->variance_of_slope), line->scatter.degrees_of_freedom};
  const double significant = calib::student_two_sided_factor(kConfidence, line->scatter.degrees_of_freedom);
  const double squared = line->slope * line->slope;
  if (squared > significant * significant * line->variance_of_slope)
    place.trend_m = line->span * std::sqrt(squared - line->variance_of_slope);
  return place;
}

}  // namespace cell
