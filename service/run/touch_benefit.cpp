#include "service/run/internal/touch_benefit.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/geometry/units.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {
namespace {

using calib::Touch;

/// Mean square of the tip's deviation over the region for this information.
double mean_square_m2(const Eigen::MatrixXd& information, const calib::TipRegion& region,
                      const std::vector<int>& columns) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  return region.mean_square(columns, columns)
      .cwiseProduct(calib::inverse_information(information).topLeftCorner(count, count))
      .sum();
}

std::map<int, std::vector<Touch>> by_face(const std::vector<Touch>& candidates) {
  std::map<int, std::vector<Touch>> sorted;
  for (const Touch& touch : candidates) sorted[touch.face].push_back(touch);
  return sorted;
}

}  // namespace

std::optional<TouchBenefit> most_beneficial_touches(const calib::IdentificationProblem& problem,
                                                    const calib::IdentificationOptions& options,
                                                    const calib::IdentificationResult& result,
                                                    const std::vector<Touch>& candidates,
                                                    const calib::TipRegion& region, double tip_rms_m) {
  if (result.status != calib::IdentificationStatus::kConverged) return std::nullopt;
  calib::IdentificationProblem longer = problem;
  std::vector<std::size_t> touches = fitted_touches(problem, result);
  const std::size_t made = touches.size();
  std::vector<int> faces;
  for (const auto& [face, of_face] : by_face(candidates)) {
    faces.push_back(face);
    for (std::size_t i = 0; i < kBenefitTouchCount; ++i) {
      touches.push_back(longer.touches.size());
      longer.touches.push_back(of_face[i % of_face.size()]);
    }
  }
  const std::vector<int> columns = calib::estimated_columns(longer, options, result.identifiable);
  calib::LeastSquares fit(longer, options, columns, touches);
  std::vector<bool> kept(touches.size(), false);
  std::fill_n(kept.begin(), made, true);
  fit.keep(kept);
  fit.linearise({result.errors, result.artefact_errors});

  const double now_m2 = mean_square_m2(fit.information(), region, columns);
  std::optional<TouchBenefit> best;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(made + i * kBenefitTouchCount);
    const Eigen::MatrixXd rows = fit.rows().middleRows(first, kBenefitTouchCount);
    const double then_m2 = mean_square_m2(fit.information() + rows.transpose() * rows, region, columns);
    const double rms_m = std::sqrt(std::max(0.0, tip_rms_m * tip_rms_m - (now_m2 - then_m2)));
    if (!best || rms_m < best->tip_rms_m) best = TouchBenefit{faces[i], kBenefitTouchCount, rms_m};
  }
  return best;
}

std::string describe(const TouchBenefit& further, double tip_rms_m) {
  const double now_mm = calib::mm_from_metres(tip_rms_m);
  const double then_mm = calib::mm_from_metres(further.tip_rms_m);
  const int digits = then_mm < 0.1 ? 3 : 2;
  return fmt::format("{} more on plane {}: {:.{}f} to {:.{}f} mm", further.count, further.face + 1, now_mm,
                     digits, then_mm, digits);
}

}  // namespace cell
