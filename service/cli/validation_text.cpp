#include "service/cli/validation_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <nlohmann/json.hpp>

namespace cell {
namespace {

using nlohmann::json;

constexpr std::array kKinds{"alpha", "d", "theta", "r", "beta"};

/// As the paper marks it: "-" no such parameter, "x" without effect, "/" carried by others or left out.
std::string entry(const json& parameters, int frame, const std::string& kind) {
  for (const json& parameter : parameters) {
    if (parameter.at("frame") != frame || parameter.at("kind") != kind) continue;
    if (parameter.at("new_error").is_number())
      return fmt::format("{:+.1e}", parameter.at("new_error").get<double>());
    return parameter.at("status") == "no_effect" ? "x" : "/";
  }
  return "-";
}

std::string new_errors_text(const json& repetition, const std::string& title) {
  if (!repetition.at("done").get<bool>())
    return fmt::format("\n{}: not made, {}\n", title, repetition.at("why_not").get<std::string>());
  std::string lines =
      fmt::format("\n{}: new errors from {} touches in {} iterations, mm and rad\n{:>3}", title,
                  repetition.at("touch_count").get<int>(), repetition.at("iterations").get<int>(), "j");
  for (const char* kind : kKinds) lines += fmt::format("{:>11}", kind);
  lines += "\n";
  const json& parameters = repetition.at("parameters");
  const int frames = parameters.back().at("frame").get<int>();
  for (int frame = 0; frame <= frames; ++frame) {
    lines += fmt::format("{:>3}", frame);
    for (const char* kind : kKinds) lines += fmt::format("{:>11}", entry(parameters, frame, kind));
    lines += "\n";
  }
  return lines;
}

std::string distances_text(const json& planes, const std::string& title) {
  if (planes.empty()) return fmt::format("\n{}: there are none\n", title);
  std::string lines =
      fmt::format("\n{}, means along the outward normals, mm\n{:>5}{:>9}{:>12}{:>12}{:>12}{:>10}{:>11}\n",
                  title, "plane", "touches", "measured", "nominal", "calibrated", "%", "removed");
  const auto figure = [](const json& value, const char* format) {
    return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : std::string("-");
  };
  for (const json& plane : planes) {
    lines += fmt::format("{:>5}{:>9}{:>12}{:>12}{:>12}{:>10}{:>9} %\n", plane.at("plane").get<int>(),
                         plane.at("touch_count").get<int>(), figure(plane.at("reference_mm"), "{:.3f}"),
                         figure(plane.at("nominal_mean_mm"), "{:.3f}"),
                         figure(plane.at("calibrated_mean_mm"), "{:.3f}"),
                         figure(plane.at("nominal_agreement_percent"), "{:.2f}"),
                         figure(plane.at("error_removed_percent"), "{:.2f}"));
  }
  return lines;
}

}  // namespace

std::string validation_text(const json& validation) {
  const json& same = validation.at("same_touches");
  std::string lines = fmt::format("{} of {} parameters identified from {} touches, then again:\n",
                                  validation.at("identifiable_count").get<int>(),
                                  same.at("parameters").size(), validation.at("touch_count").get<int>());
  lines += new_errors_text(same, "B.1 the same touches");
  lines += new_errors_text(validation.at("other_touches"), "B.2 other touches");
  lines += distances_text(validation.at("planes"), "B.3 distances of the fitted touches");
  lines += distances_text(validation.at("planes_held_out"), "B.4 distances of touches not fitted");
  if (same.at("new_error_max_si").is_number()) {
    lines +=
        fmt::format("\nB.1: the largest new error is {:.1e}, {} {:.0e} m or rad\n",
                    same.at("new_error_max_si").get<double>(),
                    same.at("passed").get<bool>() ? "below" : "NOT below", same.at("limit_si").get<double>());
  }
  return lines + (same.at("passed").get<bool>() ? "validation: passed\n" : "validation: failed\n");
}

}  // namespace cell
