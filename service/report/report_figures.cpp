#include <spdlog/fmt/fmt.h>

#include <map>
#include <nlohmann/json.hpp>

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

std::optional<double> reference_of(const Json& planes, int plane) {
  for (const Json& one : planes) {
    if (part(one, "plane") == plane && part(one, "reference_mm").is_number())
      return part(one, "reference_mm").get<double>();
  }
  return std::nullopt;
}

void add_touch(const Json& touch, PlaneFigures& figures) {
  if (!part(touch, "nominal_mm").is_number() || !part(touch, "calibrated_mm").is_number()) return;
  const double nominal = part(touch, "nominal_mm").get<double>();
  const double calibrated = part(touch, "calibrated_mm").get<double>();
  const bool is_rejected = is(part(touch, "use"), "rejected");
  const auto at = static_cast<double>(figures.nominal.points.size() + 1);
  figures.nominal.points.emplace_back(at, nominal);
  figures.calibrated.points.emplace_back(at, calibrated);
  if (figures.reference_mm)
    (is_rejected ? figures.rejected : figures.left)
        .points.emplace_back(at, 1e3 * (calibrated - *figures.reference_mm));
}

std::string pair_of(int number, int plane, const char* role, const PlaneFigures& figures) {
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

std::string condition_figure(const Json& result) {
  Series series{"condition number", Mark::kDot, {}, true};
  for (const Json& iteration : part(result, "iterations")) {
    const Json& value = part(iteration, "condition_number");
    if (value.is_number())
      series.points.emplace_back(static_cast<double>(series.points.size() + 1), value.get<double>());
  }
  return svg({.title = "Fig. 4. Condition number of the observation matrix",
              .x_label = "iteration",
              .y_label = "condition number",
              .series = {series},
              .level = {},
              .level_name = {}});
}

std::string distance_figures(const Json& report) {
  const Json& result = part(report, "result");
  std::string drawn;
  constexpr int kFirstFigure = 5;  // the paper's
  int number = kFirstFigure;
  for (const auto& [role, words, planes] :
       {std::tuple{"fit", "used", "planes"}, std::tuple{"held_out", "held-out", "planes_held_out"}}) {
    std::map<int, PlaneFigures> of_plane;
    for (const Json& touch : part(report, "touches")) {
      if (!is(part(touch, "role"), role)) continue;
      const int plane = part(touch, "plane").get<int>();
      const auto [place, is_new] = of_plane.try_emplace(plane);
      if (is_new) place->second.reference_mm = reference_of(part(result, planes), plane);
      add_touch(touch, place->second);
    }
    for (const auto& [plane, figures] : of_plane) drawn += pair_of(number++, plane, words, figures);
  }
  return drawn;
}

}  // namespace cell
