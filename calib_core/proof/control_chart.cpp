#include "calib_core/proof/control_chart.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

struct ChartBase {
  double mean = 0.0;
  double std = 0.0;
  double count = 0.0;

  /// The limit of a value whose own variance is `share` of that of one check, the base's mean being uncertain
  /// too.
  [[nodiscard]] double limit(double sigmas, double share) const {
    const double factor = student_two_sided_factor(normal_two_sided_confidence(sigmas), count - 1.0);
    return factor * std * std::sqrt(share + 1.0 / count);
  }
};

ChartBase base_of(std::span<const double> values) {
  ChartBase base{.count = static_cast<double>(values.size())};
  base.mean = std::accumulate(values.begin(), values.end(), 0.0) / base.count;
  double squares = 0.0;
  for (const double value : values) squares += (value - base.mean) * (value - base.mean);
  base.std = std::sqrt(squares / (base.count - 1.0));
  return base;
}

}  // namespace

std::vector<ChartPoint> control_chart(std::span<const ChartedValue> values, int base_count) {
  if (base_count < 2) throw std::logic_error("the limits of a chart are from two checks or more");
  std::vector<ChartPoint> points;
  for (const ChartedValue& value : values) points.push_back({.value = value.value});
  std::vector<double> base_values;
  std::size_t after_base = 0;
  for (; after_base < values.size() && std::ssize(base_values) < base_count; ++after_base)
    if (values[after_base].counts) base_values.push_back(values[after_base].value);
  if (std::ssize(base_values) < base_count) return points;
  const ChartBase base = base_of(base_values);
  if (!(base.std > 0.0)) return points;
  double mean = base.mean;
  double forgotten = 1.0;  // (1 - share)^(2 i) after i checks
  for (std::size_t i = after_base; i < points.size(); ++i) {
    ChartPoint& point = points[i];
    point.centre = base.mean;
    point.standardised = (point.value - base.mean) / base.std;
    point.shewhart_limit = base.limit(kShewhartSigmas, 1.0);
    point.is_beyond_shewhart = std::abs(point.value - base.mean) > *point.shewhart_limit;
    if (!values[i].counts) continue;
    mean += kEwmaShare * (point.value - mean);
    forgotten *= (1.0 - kEwmaShare) * (1.0 - kEwmaShare);
    point.mean = mean;
    point.ewma_limit = base.limit(kEwmaSigmas, kEwmaShare / (2.0 - kEwmaShare) * (1.0 - forgotten));
    point.is_beyond_ewma = std::abs(mean - base.mean) > *point.ewma_limit;
  }
  return points;
}

}  // namespace calib
