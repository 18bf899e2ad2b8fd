#pragma once

#include <optional>
#include <span>
#include <vector>

/// Charts of one quantity from check to check, with limits from the cell's own first checks.
namespace calib {

/// Checks that the limits are from.
inline constexpr int kChartBaseCount = 10;
/// Shewhart's limit, and those of the exponentially weighted mean with a share of the newest value of 0.2, in
/// standard deviations that are known. Both alarm about once in 350 checks of nothing: Lucas and Saccucci,
/// Exponentially weighted moving average control schemes, 1990.
inline constexpr double kShewhartSigmas = 3.0;
inline constexpr double kEwmaShare = 0.2;
inline constexpr double kEwmaSigmas = 2.86;

struct ChartPoint {
  double value = 0.0;
  /// Nothing for the checks that the limits are from.
  std::optional<double> standardised;  // distance from the mean of the base in its standard deviations
  std::optional<double> mean;          // the exponentially weighted one
  double centre = 0.0;                 // the base's mean
  double shewhart_limit = 0.0;         // distance from the base's mean that alarms, in the unit of the values
  double ewma_limit = 0.0;
  bool is_beyond_shewhart = false;
  bool is_beyond_ewma = false;
};

/// The values in the order of their checks. The limits have the same probability of a false alarm as those of
/// known deviations: the deviation of ten values is known to Student's t, and their mean to a tenth of their
/// variance. A base that does not vary at all gives no limits: nothing alarms.
std::vector<ChartPoint> control_chart(std::span<const double> values, int base_count = kChartBaseCount);

}  // namespace calib
