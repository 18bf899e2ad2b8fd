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

/// What one check found.
struct ChartedValue {
  double value = 0.0;
  /// False of a check that has its own explanation: it is held against the limits, and is neither in the base
  /// nor in the weighted mean, which would tell of it for a dozen checks more.
  bool counts = true;
};

struct ChartPoint {
  double value = 0.0;
  /// Nothing until the base is whole.
  std::optional<double> standardised;  // distance from the mean of the base in its standard deviations
  std::optional<double>
      shewhart_limit;            // distance from the base's mean that alarms, in the unit of the values
  std::optional<double> centre;  // the base's mean
  /// These two: nothing either of a value that does not count.
  std::optional<double> mean;  // the exponentially weighted one
  std::optional<double> ewma_limit;
  bool is_beyond_shewhart = false;
  bool is_beyond_ewma = false;
};

/// The values in the order of their checks. The limits have the same probability of a false alarm as those of
/// known deviations: the deviation of ten values is known to Student's t, and their mean to a tenth of their
/// variance. The base is the first values that count; one that does not vary at all gives no limits: nothing
/// alarms.
std::vector<ChartPoint> control_chart(std::span<const ChartedValue> values, int base_count = kChartBaseCount);

}  // namespace calib
