#include "service/cli/validation_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>

#include "service/documents/plane_places.hpp"

namespace cell {
namespace {

constexpr std::array kParameterKinds{"alpha", "d", "theta", "r", "beta"};

/// As the paper marks it: "-" no such parameter, "x" without effect, "/" carried by others or left out.
std::string entry(const std::vector<RepetitionDocument::NewError>& parameters, int frame,
                  const std::string& kind) {
  for (const RepetitionDocument::NewError& parameter : parameters) {
    if (parameter.frame != frame || parameter.kind != kind) continue;
    if (parameter.new_error) return fmt::format("{:+.1e}", *parameter.new_error);
    return parameter.status == calib::ParameterStatus::kNoEffect ? "x" : "/";
  }
  return "-";
}

std::string new_errors_text(const RepetitionDocument& repetition, const std::string& title) {
  if (!repetition.done) return fmt::format("\n{}: not made, {}\n", title, repetition.why_not.value_or(""));
  std::string lines = fmt::format("\n{}: new errors from {} touches in {} iterations, mm and rad\n{:>3}",
                                  title, repetition.touch_count, repetition.iterations, "j");
  for (const char* kind : kParameterKinds) lines += fmt::format("{:>11}", kind);
  lines += "\n";
  const int frames = repetition.parameters.back().frame;
  for (int frame = 0; frame <= frames; ++frame) {
    lines += fmt::format("{:>3}", frame);
    for (const char* kind : kParameterKinds)
      lines += fmt::format("{:>11}", entry(repetition.parameters, frame, kind));
    lines += "\n";
  }
  return lines;
}

std::string distances_text(const std::vector<PlaneDistances>& planes, const std::string& title) {
  if (planes.empty()) return fmt::format("\n{}: there are none\n", title);
  std::string lines =
      fmt::format("\n{}, means along the outward normals, mm\n{:>5}{:>9}{:>12}{:>12}{:>12}{:>10}{:>11}\n",
                  title, "plane", "touches", "measured", "nominal", "calibrated", "%", "removed");
  const auto figure = [](std::optional<double> value, const char* format) {
    return value ? fmt::format(fmt::runtime(format), *value) : std::string("-");
  };
  for (const PlaneDistances& plane : planes) {
    lines += fmt::format(
        "{:>5}{:>9}{:>12}{:>12}{:>12}{:>10}{:>9} %{}{}\n", plane.plane, plane.touch_count,
        figure(plane.reference_mm, "{:.3f}"), figure(plane.nominal_mean_mm, "{:.3f}"),
        figure(plane.calibrated_mean_mm, "{:.3f}"), figure(plane.nominal_agreement_percent, "{:.2f}"),
        figure(plane.error_removed_percent, "{:.2f}"), where_in_row(plane.place, plane.tip),
        plane.estimated_offset_mm ? fmt::format("  found at {}", figure(plane.estimated_offset_mm, "{:.3f}"))
                                  : "");
  }
  return lines;
}

}  // namespace

std::string validation_text(const ValidationDocument& validation) {
  const SameTouchesDocument& same = validation.repetitions.same_touches;
  std::string lines =
      fmt::format("{} of {} parameters identified from {} touches, then again:\n",
                  validation.identifiable_count, same.parameters.size(), validation.touch_count);
  lines += new_errors_text(same, "B.1 the same touches");
  lines += new_errors_text(validation.repetitions.other_touches, "B.2 other touches");
  lines += distances_text(validation.planes, "B.3 distances of the fitted touches");
  lines += distances_text(validation.planes_held_out, "B.4 distances of touches not fitted");
  if (same.new_error_max_si) {
    lines += fmt::format("\nB.1: the largest new error is {:.1e}, {} {:.0e} m or rad\n",
                         *same.new_error_max_si, same.passed ? "below" : "NOT below", same.limit_si.value());
  }
  return lines + (same.passed ? "validation: passed\n" : "validation: failed\n");
}

}  // namespace cell
