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

std::vector<ChartPoint> control_chart(std::span<const double> values, int base_count) {
  if (base_count < 2) throw std::logic_error("the limits of a chart are from two checks or more");
  std::vector<ChartPoint> points;
  for (const double value : values) points.push_back({.value = value});
  const auto base_end = static_cast<std::size_t>(base_count);
  if (values.size() <= base_end) return points;
  const ChartBase base = base_of(values.first(base_end));
  if (!(base.std > 0.0)) return points;
  double mean = base.mean;
  double forgotten = 1.0;  // (1 - share)^(2 i) after i checks
  for (std::size_t i = base_end; i < points.size(); ++i) {
    ChartPoint& point = points[i];
    mean += kEwmaShare * (point.value - mean);
    forgotten *= (1.0 - kEwmaShare) * (1.0 - kEwmaShare);
    point.standardised = (point.value - base.mean) / base.std;
    point.mean = mean;
    point.centre = base.mean;
    point.shewhart_limit = base.limit(kShewhartSigmas, 1.0);
    point.ewma_limit = base.limit(kEwmaSigmas, kEwmaShare / (2.0 - kEwmaShare) * (1.0 - forgotten));
    point.is_beyond_shewhart = std::abs(point.value - base.mean) > point.shewhart_limit;
    point.is_beyond_ewma = std::abs(mean - base.mean) > point.ewma_limit;
  }
  return points;
}

}  // namespace calib
