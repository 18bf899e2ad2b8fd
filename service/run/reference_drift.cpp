#include "service/run/reference_drift.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace cell {

double trend_m(const std::vector<double>& readings_m) {
  const auto count = static_cast<double>(readings_m.size());
  if (readings_m.size() < 3) return 0.0;
  const double middle = (count - 1.0) / 2.0;
  const double mean_m = std::accumulate(readings_m.begin(), readings_m.end(), 0.0) / count;
  double along = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < readings_m.size(); ++i) {
    const double place = static_cast<double>(i) - middle;
    along += place * (readings_m[i] - mean_m);
    spread += place * place;
  }
  const double slope_m = along / spread;
  double scatter = 0.0;
  for (std::size_t i = 0; i < readings_m.size(); ++i)
    scatter += std::pow(readings_m[i] - mean_m - slope_m * (static_cast<double>(i) - middle), 2);
  const double variance_of_slope = scatter / (count - 2.0) / spread;
  return (count - 1.0) * std::sqrt(std::max(0.0, slope_m * slope_m - variance_of_slope));
}

}  // namespace cell
