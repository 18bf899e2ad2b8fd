#include "service/cli/plan_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

namespace cell {
namespace {

using nlohmann::json;

std::string figure(const json& value, const char* format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "unknown";
}

std::string text(const json& value) { return value.get<std::string>(); }

std::string touches_text(const json& plan) {
  std::string lines = fmt::format("{:>5}{:>8}{:>10}{:>12}{:>12}{:>12}\n", "plane", "fitted", "held out",
                                  "tilt up to", "miss up to", "search");
  for (const json& plane : plan.at("planes")) {
    double tilt_deg = 0.0, miss_mm = 0.0, search_mm = 0.0;
    for (const json& touch : plan.at("touches")) {
      if (touch.at("plane") != plane.at("plane")) continue;
      tilt_deg = std::max(tilt_deg, touch.at("tilt_deg").get<double>());
      miss_mm = std::max(miss_mm, touch.at("predicted_miss_mm").get<double>());
      search_mm = std::max(search_mm, touch.at("search_length_mm").get<double>());
    }
    lines += fmt::format("{:>5}{:>8}{:>10}{:>8.1f} deg{:>9.1f} mm{:>9.1f} mm\n", plane.at("plane").get<int>(),
                         plane.at("fit").get<int>(), plane.at("held_out").get<int>(), tilt_deg, miss_mm,
                         search_mm);
  }
  return lines;
}

std::string tip_text(const json& tip) {
  std::string lines =
      fmt::format("\n{:<34}{:>15}{:>17}\n", "predicted tip error, rms", "workspace box", "joint ranges");
  const auto line = [&lines](const std::string& of, const json& figures) {
    lines += fmt::format("{:<34}{:>12} mm{:>14} mm\n", "  " + of,
                         figure(figures.at("workspace_box_rms_mm"), "{:.3f}"),
                         figure(figures.at("joint_ranges_rms_mm"), "{:.3f}"));
  };
  line("stylus tip", tip);
  for (const json& tool : tip.at("tools")) line(text(tool.at("name")), tool);
  return lines;
}

/// Three to a line: "r3 +- 0.0512 mm".
std::string parameters_text(const json& parameters) {
  constexpr int kInALine = 3;
  std::string lines = "\npredicted standard uncertainty of what is identified\n";
  int count = 0;
  for (const json& parameter : parameters) {
    if (!parameter.at("std_uncertainty").is_number()) continue;
    const bool length = parameter.at("unit") == "mm";
    lines += fmt::format("  {:<9}{:>9} {:<5}", text(parameter.at("name")),
                         figure(parameter.at("std_uncertainty"), length ? "{:.4f}" : "{:.6f}"),
                         text(parameter.at("unit")));
    if (++count % kInALine == 0) lines += "\n";
  }
  return count % kInALine == 0 ? lines : lines + "\n";
}

std::string duration_text(double seconds) {
  const int whole = static_cast<int>(seconds + 0.5);
  return fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

}  // namespace

std::string plan_text(const json& plan) {
  std::string lines =
      fmt::format("plan {} of recipe {} in cell {}: {} touches, {}\n\n", text(plan.at("plan_id")),
                  text(plan.at("recipe")), text(plan.at("cell")), plan.at("touch_count").get<int>(),
                  duration_text(plan.at("duration_s").get<double>()));
  lines += touches_text(plan);
  lines += fmt::format("\n{} of {} parameters identifiable, condition number {} (columns of unit norm: {})\n",
                       plan.at("identifiable_count").get<int>(), plan.at("parameters").size(),
                       figure(plan.at("condition_number"), "{:.1f}"),
                       figure(plan.at("scaled_condition_number"), "{:.1f}"));
  lines += tip_text(plan.at("tip_uncertainty"));
  lines += parameters_text(plan.at("parameters"));
  lines += "\nwhat limits it\n";
  for (const json& words : plan.at("limits").at("words")) lines += fmt::format("  {}\n", text(words));
  for (const json& warning : plan.at("warnings")) lines += fmt::format("\nwarning: {}\n", text(warning));
  return lines;
}

std::string places_text(const json& places) {
  std::string lines = fmt::format("{:>4}{:>27}{:>10}{:>16}{:>15}{:>11}{:>12}\n", "", "shift x, y, z (mm)",
                                  "yaw", "workspace box", "joint ranges", "condition", "duration");
  int rank = 0;
  for (const json& place : places.at("places")) {
    const json& shift = place.at("shift_mm");
    lines += fmt::format("{:>3}.{:>27}{:>6.1f} deg", ++rank,
                         fmt::format("{:.0f}, {:.0f}, {:.0f}", shift[0].get<double>(), shift[1].get<double>(),
                                     shift[2].get<double>()),
                         place.at("yaw_deg").get<double>());
    if (place.at("feasible").get<bool>()) {
      lines += fmt::format(
          "{:>13} mm{:>12} mm{:>11}{:>12}", figure(place.at("workspace_box_rms_mm"), "{:.3f}"),
          figure(place.at("joint_ranges_rms_mm"), "{:.3f}"), figure(place.at("condition_number"), "{:.1f}"),
          duration_text(place.at("duration_s").get<double>()));
      if (place.at("fully_planned").get<bool>()) lines += "  fully planned";
    } else {
      lines += "  " + text(place.at("reason"));
    }
    lines += place.at("present").get<bool>() ? "  (where it is now)\n" : "\n";
  }
  return lines;
}

}  // namespace cell
