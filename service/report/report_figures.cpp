#include <spdlog/fmt/fmt.h>

#include <map>
#include <tuple>

#include "service/documents/plane_places.hpp"
#include "service/report/internal/figure.hpp"
#include "service/report/internal/report_parts.hpp"

namespace cell {
namespace {

constexpr const char* kUsedWords = "used";
constexpr const char* kHeldOutWords = "held-out";

/// The series of one plane and role: distances before and after, and the residuals.
struct PlaneFigures {
  explicit PlaneFigures(const Words& words)
      : nominal{words("nominal"), Mark::kRing, {}, false},
        calibrated{words("calibrated"), Mark::kDot, {}, false},
        left{"", Mark::kDot, {}, false},
        rejected{words("rejected touch"), Mark::kCross, {}, false} {}

  Series nominal, calibrated, left, rejected;
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

std::string pair_of(const Words& words, int number, const std::string& plane, const char* role,
                    const PlaneFigures& figures) {
  Series kept = figures.left;
  kept.name = words(role);
  const Figure distances{.title = words(role == kHeldOutWords ? "Fig. {}. d{} of the held-out touches"
                                                              : "Fig. {}. d{} of the used touches",
                                        number, plane),
                         .x_label = words("touch on the plane"),
                         .y_label = words("distance, mm"),
                         .series = {figures.nominal, figures.calibrated},
                         .level = figures.reference_mm,
                         .level_name = words("reference")};
  Figure left{.title = words("What is left of d{} after calibration", plane),
              .x_label = words("touch on the plane"),
              .y_label = words("calibrated - reference, µm"),
              .series = {kept},
              .level = 0.0,
              .level_name = words("reference")};
  if (!figures.rejected.points.empty()) left.series.push_back(figures.rejected);
  return svg(words, distances) + svg(words, left);
}

}  // namespace

std::string condition_figure(const Words& words, const ResultDocument& result) {
  Series series{words("condition number"), Mark::kDot, {}, true};
  for (const ResultDocument::Iteration& iteration : result.iterations) {
    if (iteration.condition_number)
      series.points.emplace_back(static_cast<double>(series.points.size() + 1), *iteration.condition_number);
  }
  return svg(words, {.title = words("Fig. 4. Condition number of the observation matrix"),
                     .x_label = words("iteration"),
                     .y_label = words("condition number"),
                     .series = {series},
                     .level = {},
                     .level_name = {}});
}

std::string distance_figures(const Words& words, const RunReport& report) {
  static const ResultDocument kNoResult;
  const ResultDocument& result = report.result ? report.result->value : kNoResult;
  const PlanePlaces places = places_of(words, result);
  std::string drawn;
  constexpr int kFirstFigure = 5;  // the paper's
  int number = kFirstFigure;
  for (const auto& [role, role_words, planes] :
       {std::tuple{calib::TouchRole::kFit, kUsedWords, &result.planes},
        std::tuple{calib::TouchRole::kHeldOut, kHeldOutWords, &result.planes_held_out}}) {
    std::map<int, PlaneFigures> of_plane;
    for (const RunReport::Touch& touch : report.touches) {
      if (touch.role != role) continue;
      const auto [place, is_new] = of_plane.try_emplace(touch.plane, words);
      if (is_new) place->second.reference_mm = reference_of(*planes, touch.plane);
      add_touch(touch, place->second);
    }
    for (const auto& [plane, figures] : of_plane)
      drawn += pair_of(words, number++, plane_text(plane, places), role_words, figures);
  }
  return drawn;
}

}  // namespace cell
