#include "service/run/reference_drift.hpp"

#include <cmath>
#include <numeric>

#include "calib_core/numerics/distributions.hpp"

namespace cell {
namespace {

constexpr double kConfidence = 0.997;

}  // namespace

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
  const double significant = calib::student_two_sided_factor(kConfidence, count - 2.0);
  if (!(slope_m * slope_m > significant * significant * variance_of_slope)) return 0.0;
  return (count - 1.0) * std::sqrt(slope_m * slope_m - variance_of_slope);
}

}  // namespace cell
