#include "service/cli/result_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

namespace cell {
namespace {

using nlohmann::json;

std::string figure(const json& value, const char* format, const char* unknown = "-") {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : unknown;
}

std::string text(const json& value) { return value.is_string() ? value.get<std::string>() : "-"; }

/// "grouped: r3 x 1.000"
std::string status_of(const json& parameter) {
  const std::string status = parameter.at("status");
  if (status != "grouped") return status == "no_effect" ? "no effect" : status;
  std::string into;
  constexpr std::size_t kShown = 3;
  const json& factors = parameter.at("grouped_with");
  for (std::size_t i = 0; i < factors.size() && i < kShown; ++i) {
    into += fmt::format("{}{} x {:.4g}", i == 0 ? "" : ", ", factors[i].at("name").get<std::string>(),
                        factors[i].at("factor").get<double>());
  }
  return fmt::format("grouped into {}{}", into, factors.size() > kShown ? ", ..." : "");
}

std::string parameters_text(const json& parameters) {
  std::string lines =
      fmt::format("{:<9}{:>12}{:>12}  {:<5}{}\n", "error of", "nominal", "error", "unit", "status");
  for (const json& parameter : parameters) {
    const bool length = parameter.at("unit") == "mm";
    lines += fmt::format("{:<9}{:>12}{:>12}  {:<5}{}\n", parameter.at("name").get<std::string>(),
                         figure(parameter.at("nominal"), length ? "{:.3f}" : "{:.5f}"),
                         figure(parameter.at("error"), length ? "{:+.4f}" : "{:+.6f}"),
                         parameter.at("unit").get<std::string>(), status_of(parameter));
  }
  return lines;
}

std::string planes_text(const json& planes, const char* title) {
  if (planes.empty()) return {};
  std::string lines =
      fmt::format("\n{}\n{:>5}{:>9}{:>13}{:>12}{:>14}{:>12}{:>14}{:>11}\n", title, "plane", "touches",
                  "reference", "nominal", "calibrated", "rms before", "rms after", "removed");
  for (const json& plane : planes) {
    lines += fmt::format(
        "{:>5}{:>9}{:>10} mm{:>9} mm{:>11} mm{:>9} mm{:>11} mm{:>9} %\n", plane.at("plane").get<int>(),
        plane.at("touch_count").get<int>(), figure(plane.at("reference_mm"), "{:.3f}"),
        figure(plane.at("nominal_mean_mm"), "{:.3f}"), figure(plane.at("calibrated_mean_mm"), "{:.3f}"),
        figure(plane.at("nominal_rms_mm"), "{:.3f}"), figure(plane.at("calibrated_rms_mm"), "{:.3f}"),
        figure(plane.at("error_removed_percent"), "{:.2f}"));
  }
  return lines;
}

}  // namespace

std::string result_text(const json& result) {
  std::string lines = parameters_text(result.at("parameters"));
  lines += fmt::format("\n{} of {} parameters identified from {} touches in {} iterations\n",
                       result.at("identifiable_count").get<int>(), result.at("parameters").size(),
                       result.at("touch_count").get<int>(), result.at("iterations").size());
  lines += "condition number, iteration by iteration:";
  for (const json& iteration : result.at("iterations"))
    lines += " " + figure(iteration.at("condition_number"), "{:.1f}");
  lines +=
      fmt::format(" (columns of unit norm: {})\n", figure(result.at("scaled_condition_number"), "{:.1f}"));
  const json& fit = result.at("fit");
  lines += fmt::format("noise of a touch: declared {} um, from the residuals {} um\n",
                       figure(fit.at("noise_declared_um"), "{:.1f}"),
                       figure(fit.at("noise_estimated_um"), "{:.1f}"));
  lines += planes_text(result.at("planes"), "distances of the fitted touches from the block's origin");
  lines += planes_text(result.at("planes_held_out"), "distances of the held-out touches");
  lines += planes_text(result.at("planes_proof"), "distances of the proof touches");
  const json& verdict = result.at("verdict");
  lines += verdict.at("accepted").get<bool>() ? "\nverdict: accepted\n" : "\nverdict: rejected\n";
  for (const json& reason : verdict.at("reasons"))
    lines += fmt::format("  - {}\n", reason.get<std::string>());
  return lines;
}

std::string status_text(const json& status) {
  std::string lines = fmt::format("state       {}\n", text(status.at("state")));
  const bool connected = status.at("controller_connected").get<bool>();
  const auto yes_no = [](const json& value, const char* yes, const char* no) {
    return value.is_boolean() ? (value.get<bool>() ? yes : no) : "unknown";
  };
  lines += fmt::format(
      "controller  {}, power {}, mode {}, emergency stop {}, data {} ms old\n",
      connected ? "connected" : "not connected", yes_no(status.at("controller_powered"), "on", "off"),
      status.at("controller_mode").is_string() ? text(status.at("controller_mode")) : "unknown",
      yes_no(status.at("controller_estop"), "ACTIVE", "none"),
      figure(status.at("data_age_ms"), "{:.0f}", "?"));
  if (status.at("run_id").is_string()) {
    lines += fmt::format(
        "run         {} ({}), {} of {} touches, {} identifiable, condition number {}, verdict {}\n",
        text(status.at("run_id")), text(status.at("recipe")), status.at("touches_done").get<int>(),
        figure(status.at("touches_total"), "{:.0f}"), figure(status.at("identifiable_count"), "{:.0f}"),
        figure(status.at("condition_number"), "{:.0f}"), text(status.at("verdict")));
  }
  if (status.at("fault_code").is_string()) {
    lines += fmt::format("fault       {}: {}\n  robot     {}\n  next      {}\n",
                         text(status.at("fault_code")), text(status.at("fault_message")),
                         text(status.at("fault_robot_action")), text(status.at("fault_next_step")));
  }
  return lines;
}

std::string runs_text(const json& runs) {
  std::string lines = fmt::format("{:<6}{:<10}{:<13}{:<12}{:>11}  {:<26}{}\n", "run", "recipe", "outcome",
                                  "verdict", "touches", "started", "fault");
  for (const json& run : runs.at("runs")) {
    lines += fmt::format(
        "{:<6}{:<10}{:<13}{:<12}{:>11}  {:<26}{}\n", text(run.at("id")), text(run.at("recipe")),
        text(run.at("outcome")), text(run.at("verdict")),
        fmt::format("{}/{}", run.at("touches_done").get<int>(), figure(run.at("touches_total"), "{:.0f}")),
        text(run.at("started_at")), run.at("fault_code").is_string() ? text(run.at("fault_code")) : "");
  }
  return lines;
}

}  // namespace cell
