#include "service/cli/result_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "service/run/readiness.hpp"

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

/// A member of a result document; documents of an older daemon may lack it.
const json& part(const json& object, const char* key) {
  static const json nothing;
  const auto found = object.is_object() ? object.find(key) : object.end();
  return found == object.end() ? nothing : *found;
}

/// Half the width of the 95 % interval.
std::string half_width(const json& parameter, const char* format) {
  const json& interval = part(parameter, "interval95");
  if (!interval.is_array()) return "";
  return figure(0.5 * (interval[1].get<double>() - interval[0].get<double>()), format);
}

std::string parameters_text(const json& parameters) {
  std::string lines = fmt::format("{:<9}{:>12}{:>12}{:>12}  {:<5}{}\n", "error of", "nominal", "error",
                                  "+- (95 %)", "unit", "status");
  for (const json& parameter : parameters) {
    const bool length = parameter.at("unit") == "mm";
    lines += fmt::format("{:<9}{:>12}{:>12}{:>12}  {:<5}{}\n", parameter.at("name").get<std::string>(),
                         figure(parameter.at("nominal"), length ? "{:.3f}" : "{:.5f}"),
                         figure(parameter.at("error"), length ? "{:+.4f}" : "{:+.6f}"),
                         half_width(parameter, length ? "{:.4f}" : "{:.6f}"),
                         parameter.at("unit").get<std::string>(), status_of(parameter));
  }
  return lines;
}

std::string rejected_text(const json& result) {
  std::string lines;
  for (const json& touch : part(result, "rejected_touches")) {
    lines += fmt::format("touch {} rejected: {}, {} mm off\n", touch.at("touch").get<int>(),
                         touch.at("reason") == "wrong_plane" ? "on another plane" : "does not fit the others",
                         figure(touch.at("residual_mm"), "{:+.3f}"));
  }
  return lines;
}

std::string fit_text(const json& fit) {
  std::string lines = fmt::format("noise of a touch: declared {} um, from the residuals {} um\n",
                                  figure(part(fit, "noise_declared_um"), "{:.1f}"),
                                  figure(part(fit, "noise_estimated_um"), "{:.1f}"));
  if (!part(fit, "lack_of_fit_p").is_number()) return lines;
  lines += fmt::format("lack of fit: p = {}", figure(fit.at("lack_of_fit_p"), "{:.2g}"));
  for (const json& plane : part(fit, "planes"))
    lines += fmt::format("{} {} {}", &plane == &part(fit, "planes")[0] ? "; plane" : ",",
                         plane.at("plane").get<int>(), figure(plane.at("p"), "{:.2g}"));
  return lines + "\n";
}

std::string artefact_text(const json& parameters) {
  if (parameters.empty()) return {};
  std::string lines = fmt::format("\n{:<16}{:>12}{:>12}  {:<6}{}\n", "block and probe", "value", "+- (std)",
                                  "unit", "status");
  for (const json& parameter : parameters) {
    const char* format = parameter.at("unit") == "rad" ? "{:.6f}" : "{:.4f}";
    lines +=
        fmt::format("{:<16}{:>12}{:>12}  {:<6}{}\n", text(parameter.at("name")),
                    figure(parameter.at("value"), format), figure(parameter.at("std_uncertainty"), format),
                    text(parameter.at("unit")), text(parameter.at("status")));
  }
  return lines;
}

/// The tip's uncertainty by source and by region.
std::string tip_text(const json& tip) {
  std::string lines = "\npredicted uncertainty of the tip, rms\n";
  const auto line = [&lines](const std::string& where, const json& value) {
    lines += fmt::format("  {:<34}{:>10} mm\n", where, figure(value, "{:.3f}", "unknown"));
  };
  line("at the block", part(tip, "at_block_rms_mm"));
  line("in the workspace box", part(tip, "workspace_box_rms_mm"));
  for (const json& source : part(tip, "sources"))
    line("  from " + text(source.at("name")), source.at("workspace_box_rms_mm"));
  line("over the joint ranges", part(tip, "joint_ranges_rms_mm"));
  for (const json& tool : part(tip, "tools")) {
    line(text(tool.at("name")) + ", in the workspace box", tool.at("workspace_box_rms_mm"));
    line(text(tool.at("name")) + ", over the joint ranges", tool.at("joint_ranges_rms_mm"));
  }
  return lines;
}

std::string scale_text(const json& scale) {
  return fmt::format("common scale of all lengths: from {}, +- {} ppm (std); they moved by {} ppm\n",
                     text(part(scale, "source")), figure(part(scale, "std_uncertainty_ppm"), "{:.0f}"),
                     figure(part(scale, "stretch_ppm"), "{:+.0f}"));
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
  if (const json& why = part(part(result, "rank"), "explanation");
      why.is_string() && !why.empty() && why != "")
    lines += fmt::format("not more of them: {}\n", text(why));
  lines += fit_text(result.at("fit"));
  lines += scale_text(result.at("scale"));
  lines += rejected_text(result);
  lines += artefact_text(part(result, "artefact_parameters"));
  for (const json& stiffness : part(result, "stiffness")) {
    lines += fmt::format("compliance of joint {}: {} +- {} rad/Nm\n", stiffness.at("joint").get<int>(),
                         figure(stiffness.at("compliance_rad_per_nm"), "{:.3g}"),
                         figure(stiffness.at("std_uncertainty"), "{:.2g}"));
  }
  lines += tip_text(result.at("tip_uncertainty"));
  lines += planes_text(result.at("planes"), "distances of the fitted touches from the block's origin");
  lines += planes_text(result.at("planes_held_out"), "distances of the held-out touches");
  lines += planes_text(result.at("planes_proof"), "distances of the proof touches");
  const json& verdict = result.at("verdict");
  const json& reasons = verdict.at("reasons");
  for (const json& warning : result.at("warnings")) {
    if (std::ranges::find(reasons, warning) == reasons.end())
      lines += fmt::format("\nwarning: {}\n", text(warning));
  }
  lines += verdict.at("accepted").get<bool>() ? "\nverdict: accepted\n" : "\nverdict: rejected\n";
  for (const json& reason : reasons) lines += fmt::format("  - {}\n", reason.get<std::string>());
  return lines;
}

std::string status_text(const json& status) {
  const auto text_or_unknown = [](const json& value) { return value.is_string() ? text(value) : "unknown"; };
  std::string lines = fmt::format("state       {}\n", text(status.at("state")));
  const bool connected = status.at("controller_connected").get<bool>();
  const auto yes_no = [](const json& value, const char* yes, const char* no) {
    return value.is_boolean() ? (value.get<bool>() ? yes : no) : "unknown";
  };
  lines += fmt::format(
      "controller  {}, power {}, mode {}, emergency stop {}, data {} ms old\n"
      "cell        {}, touch test {}, probe {}, permit {}\n",
      connected ? "connected" : "not connected", yes_no(status.at("controller_powered"), "on", "off"),
      text_or_unknown(status.at("controller_mode")), yes_no(status.at("controller_estop"), "ACTIVE", "none"),
      figure(status.at("data_age_ms"), "{:.0f}", "?"),
      yes_no(status.at("controller_cell_closed"), "closed", "OPEN"),
      yes_no(status.at("controller_touch_tested"), "made", "missing"), text_or_unknown(status.at("probe")),
      text_or_unknown(status.at("controller_permit")));
  if (status.at("waiting_for").is_string())
    lines += fmt::format("waiting     {}\n", awaited_instruction(text(status.at("waiting_for"))));
  if (status.at("run_id").is_string()) {
    lines += fmt::format(
        "run         {} ({}), {} of {} touches, {} identifiable, condition number {}, tip +- {} mm, verdict "
        "{}\n",
        text(status.at("run_id")), text(status.at("recipe")), status.at("touches_done").get<int>(),
        figure(status.at("touches_total"), "{:.0f}"), figure(status.at("identifiable_count"), "{:.0f}"),
        figure(status.at("condition_number"), "{:.0f}"), figure(status.at("predicted_tip_rms_mm"), "{:.3f}"),
        text(status.at("verdict")));
  }
  lines += more_text(status);
  if (status.at("fault_code").is_string()) {
    lines += fmt::format("fault       {}: {}\n  robot     {}\n  next      {}\n",
                         text(status.at("fault_code")), text(status.at("fault_message")),
                         text(status.at("fault_robot_action")), text(status.at("fault_next_step")));
  }
  return lines;
}

std::string more_text(const json& status) {
  const json& more = status.at("more_would_bring");
  return more.is_string() ? fmt::format("more        {}\n", text(more)) : "";
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
