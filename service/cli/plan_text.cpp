#include "service/cli/plan_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "service/documents/plane_places.hpp"

namespace cell {
namespace {

std::string known_figure(std::optional<double> value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "unknown";
}

std::string touches_text(const PlanDocument& plan) {
  std::string lines = fmt::format("{:>5}{:>8}{:>10}{:>12}{:>12}{:>12}\n", "plane", "fitted", "held out",
                                  "tilt up to", "miss up to", "search");
  for (const PlanDocument::TouchesOfPlane& plane : plan.planes) {
    double tilt_deg = 0.0, miss_mm = 0.0, search_mm = 0.0;
    for (const PlanDocument::Touch& touch : plan.touches) {
      if (touch.plane != plane.plane) continue;
      tilt_deg = std::max(tilt_deg, touch.tilt_deg);
      miss_mm = std::max(miss_mm, touch.predicted_miss_mm);
      search_mm = std::max(search_mm, touch.search_length_mm);
    }
    lines += fmt::format("{:>5}{:>8}{:>10}{:>8.1f} deg{:>9.1f} mm{:>9.1f} mm{}\n", plane.plane, plane.fit,
                         plane.held_out, tilt_deg, miss_mm, search_mm, where_in_row(plane.place, plane.tip));
  }
  return lines;
}

/// Where a person has work in the middle of the run; nothing for a recipe with one place.
std::string moves_text(const PlanDocument& plan) {
  std::string lines;
  if (!plan.leaving) return lines;
  for (const PlanDocument::Leaving& leaving : *plan.leaving) {
    const auto next = static_cast<std::size_t>(leaving.touches);
    const std::string place = next < plan.touches.size() ? plan.touches[next].place.value_or("first") : "";
    lines += fmt::format("\nbehind touch {} the arm parks and waits until the block is brought to {}", next,
                         place);
  }
  return lines + "\n";
}

std::string predicted_tip_text(const TipDocument& tip) {
  std::string lines =
      fmt::format("\n{:<34}{:>15}{:>17}\n", "predicted tip error, rms", "workspace box", "joint ranges");
  const auto line = [&lines](const std::string& of, const auto& figures) {
    lines += fmt::format("{:<34}{:>12} mm{:>14} mm\n", "  " + of,
                         known_figure(figures.workspace_box_rms_mm, "{:.3f}"),
                         known_figure(figures.joint_ranges_rms_mm, "{:.3f}"));
  };
  line("stylus tip", tip);
  for (const TipDocument::Tool& tool : tip.tools) line(tool.name, tool);
  return lines;
}

/// Three to a line: "r3 +- 0.0512 mm".
std::string parameters_text(const std::vector<PlannedParameter>& parameters) {
  constexpr int kInALine = 3;
  std::string lines = "\npredicted standard uncertainty of what is identified\n";
  int count = 0;
  for (const PlannedParameter& parameter : parameters) {
    if (!parameter.std_uncertainty) continue;
    const bool length = parameter.unit == "mm";
    lines +=
        fmt::format("  {:<9}{:>9} {:<5}", parameter.name,
                    known_figure(parameter.std_uncertainty, length ? "{:.4f}" : "{:.6f}"), parameter.unit);
    if (++count % kInALine == 0) lines += "\n";
  }
  return count % kInALine == 0 ? lines : lines + "\n";
}

std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

}  // namespace

std::string plan_text(const PlanDocument& plan) {
  std::string lines =
      fmt::format("plan {} of recipe {} in cell {}: {} touches, {}\n\n", plan.plan_id.value(), plan.recipe,
                  plan.cell, plan.touch_count, duration_text(plan.duration_s.value()));
  lines += touches_text(plan);
  lines += moves_text(plan);
  lines += fmt::format("\n{} of {} parameters identifiable, condition number {} (columns of unit norm: {})\n",
                       plan.identifiable_count, plan.parameters.size(),
                       known_figure(plan.condition_number, "{:.1f}"),
                       known_figure(plan.scaled_condition_number, "{:.1f}"));
  lines += predicted_tip_text(plan.tip_uncertainty);
  lines += parameters_text(plan.parameters);
  lines += "\nwhat limits it\n";
  for (const std::string& words : plan.limits.words) lines += fmt::format("  {}\n", words);
  for (const std::string& warning : plan.warnings) lines += fmt::format("\nwarning: {}\n", warning);
  return lines;
}

std::string places_text(const PlacesDocument& places) {
  std::string lines = fmt::format("{:>4}{:>27}{:>10}{:>16}{:>15}{:>11}{:>12}\n", "", "shift x, y, z (mm)",
                                  "yaw", "workspace box", "joint ranges", "condition", "duration");
  int rank = 0;
  for (const PlacesDocument::Place& place : places.places) {
    const auto& shift = place.shift_mm;
    lines += fmt::format("{:>3}.{:>27}{:>6.1f} deg", ++rank,
                         fmt::format("{:.0f}, {:.0f}, {:.0f}", shift[0], shift[1], shift[2]), place.yaw_deg);
    if (place.feasible) {
      lines += fmt::format(
          "{:>13} mm{:>12} mm{:>11}{:>12}", known_figure(place.workspace_box_rms_mm, "{:.3f}"),
          known_figure(place.joint_ranges_rms_mm, "{:.3f}"), known_figure(place.condition_number, "{:.1f}"),
          duration_text(place.duration_s.value()));
      if (place.fully_planned) lines += "  fully planned";
    } else {
      lines += "  " + place.reason.value_or("");
    }
    lines += place.present ? "  (where it is now)\n" : "\n";
  }
  return lines;
}

}  // namespace cell
