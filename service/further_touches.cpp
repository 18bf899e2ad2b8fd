#include "service/further_touches.hpp"

#include <spdlog/fmt/fmt.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "calib_core/least_squares.hpp"
#include "calib_core/units.hpp"
#include "service/verdict.hpp"

namespace cell {
namespace {

using calib::Touch;

/// Columns that the result estimated.
std::vector<int> estimated_columns(const calib::IdentificationOptions& options,
                                   const calib::IdentificationResult& result) {
  std::vector<int> columns;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    if (is_estimated(options, result.identifiable, i)) columns.push_back(i);
  }
  for (int i = 0; options.stiffness && i < calib::kComplianceCount; ++i)
    columns.push_back(calib::kErrorParameterCount + i);
  return columns;
}

/// Mean square of the tip's deviation over the region for this information.
double mean_square_m2(const Eigen::MatrixXd& information, const calib::TipRegion& region,
                      const std::vector<int>& columns) {
  const auto count = static_cast<Eigen::Index>(columns.size());
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(information.rows(), count);
  wanted.topRows(count) = region.mean_square(columns, columns);
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::MatrixXd solved = scale.asDiagonal() * cholesky.solve(scale.asDiagonal() * wanted);
  return solved.topRows(count).trace();
}

std::map<int, std::vector<Touch>> by_face(const std::vector<Touch>& candidates) {
  std::map<int, std::vector<Touch>> sorted;
  for (const Touch& touch : candidates) sorted[touch.face].push_back(touch);
  return sorted;
}

std::vector<std::size_t> fitted_touches(const calib::IdentificationProblem& problem,
                                        const calib::IdentificationResult& result) {
  std::vector<std::size_t> fitted;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const bool rejected =
        std::ranges::find(result.rejected, i, &calib::RejectedTouch::touch) != result.rejected.end();
    if (problem.touches[i].role == calib::TouchRole::kFit && !rejected) fitted.push_back(i);
  }
  return fitted;
}

}  // namespace

std::optional<FurtherTouches> best_further_touches(const calib::IdentificationProblem& problem,
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
    for (std::size_t i = 0; i < kFurtherTouchCount; ++i) {
      touches.push_back(longer.touches.size());
      longer.touches.push_back(of_face[i % of_face.size()]);
    }
  }
  const std::vector<int> columns = estimated_columns(options, result);
  calib::LeastSquares fit(longer, options, columns, touches);
  std::vector<bool> kept(touches.size(), false);
  std::fill_n(kept.begin(), made, true);
  fit.keep(kept);
  fit.linearise({result.errors, result.artefact_errors});

  const double now_m2 = mean_square_m2(fit.information(), region, columns);
  std::optional<FurtherTouches> best;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto first = static_cast<Eigen::Index>(made + i * kFurtherTouchCount);
    const Eigen::MatrixXd rows = fit.rows().middleRows(first, kFurtherTouchCount);
    const double then_m2 = mean_square_m2(fit.information() + rows.transpose() * rows, region, columns);
    const double rms_m = std::sqrt(std::max(0.0, tip_rms_m * tip_rms_m - (now_m2 - then_m2)));
    if (!best || rms_m < best->tip_rms_m) best = FurtherTouches{faces[i], kFurtherTouchCount, rms_m};
  }
  return best;
}

std::string describe(const FurtherTouches& further, double tip_rms_m) {
  const double now_mm = calib::mm_from_metres(tip_rms_m);
  const double then_mm = calib::mm_from_metres(further.tip_rms_m);
  const int digits = then_mm < 0.1 ? 3 : 2;
  return fmt::format("{} more on plane {}: {:.{}f} to {:.{}f} mm", further.count, further.face + 1, now_mm,
                     digits, then_mm, digits);
}

}  // namespace cell
