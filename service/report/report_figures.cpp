#include <spdlog/fmt/fmt.h>

#include <map>
#include <tuple>

#include "service/documents/plane_places.hpp"
#include "service/report/internal/figure.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

/// The series of one plane and role: distances before and after, and the residuals.
struct PlaneFigures {
  Series nominal{"nominal", Mark::kRing, {}, false};
  Series calibrated{"calibrated", Mark::kDot, {}, false};
  Series left{"used", Mark::kDot, {}, false};
  Series rejected{"rejected", Mark::kCross, {}, false};
  std::optional<double> reference_mm;
};

/// Where the face lies: as written, or where it was found in place.
std::optional<double> reference_of(const std::vector<PlaneDistances>& planes, int plane) {
  for (const PlaneDistances& one : planes) {
    if (one.plane == plane && one.estimated_offset_mm) return one.estimated_offset_mm;
    if (one.plane == plane && one.reference_mm) return one.reference_mm;
  }
  return std::nullopt;
}

void add_touch(const RunReport::Touch& touch, PlaneFigures& figures) {
  if (!touch.nominal_mm || !touch.calibrated_mm) return;
  const bool is_rejected = touch.use == TouchUse::kRejected;
  const auto at = static_cast<double>(figures.nominal.points.size() + 1);
  figures.nominal.points.emplace_back(at, *touch.nominal_mm);
  figures.calibrated.points.emplace_back(at, *touch.calibrated_mm);
  if (figures.reference_mm)
    (is_rejected ? figures.rejected : figures.left)
        .points.emplace_back(at, 1e3 * (*touch.calibrated_mm - *figures.reference_mm));
}

std::string pair_of(int number, const std::string& plane, const char* role, const PlaneFigures& figures) {
  Series kept = figures.left;
  kept.name = role;
  const Figure distances{.title = fmt::format("Fig. {}. d{} of the {} touches", number, plane, role),
                         .x_label = "touch on the plane",
                         .y_label = "distance, mm",
                         .series = {figures.nominal, figures.calibrated},
                         .level = figures.reference_mm,
                         .level_name = "reference"};
  Figure left{.title = fmt::format("What is left of d{} after calibration", plane),
              .x_label = "touch on the plane",
              .y_label = "calibrated - reference, µm",
              .series = {kept},
              .level = 0.0,
              .level_name = "reference"};
  if (!figures.rejected.points.empty()) left.series.push_back(figures.rejected);
  return svg(distances) + svg(left);
}

}  // namespace

std::string condition_figure(const ResultDocument& result) {
  Series series{"condition number", Mark::kDot, {}, true};
  for (const ResultDocument::Iteration& iteration : result.iterations) {
    if (iteration.condition_number)
      series.points.emplace_back(static_cast<double>(series.points.size() + 1), *iteration.condition_number);
  }
  return svg({.title = "Fig. 4. Condition number of the observation matrix",
              .x_label = "iteration",
              .y_label = "condition number",
              .series = {series},
              .level = {},
              .level_name = {}});
}

std::string distance_figures(const RunReport& report) {
  static const ResultDocument kNoResult;
  const ResultDocument& result = report.result ? report.result->value : kNoResult;
  const PlanePlaces places = plane_places_of(result);
  std::string drawn;
  constexpr int kFirstFigure = 5;  // the paper's
  int number = kFirstFigure;
  for (const auto& [role, words, planes] :
       {std::tuple{calib::TouchRole::kFit, "used", &result.planes},
        std::tuple{calib::TouchRole::kHeldOut, "held-out", &result.planes_held_out}}) {
    std::map<int, PlaneFigures> of_plane;
    for (const RunReport::Touch& touch : report.touches) {
      if (touch.role != role) continue;
      const auto [place, is_new] = of_plane.try_emplace(touch.plane);
      if (is_new) place->second.reference_mm = reference_of(*planes, touch.plane);
      add_touch(touch, place->second);
    }
    for (const auto& [plane, figures] : of_plane)
      drawn += pair_of(number++, plane_text(plane, places), words, figures);
  }
  return drawn;
}

}  // namespace cell
