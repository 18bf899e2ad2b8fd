#include "service/cli/result_text.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "service/documents/limit_table.hpp"
#include "service/documents/plane_places.hpp"
#include "service/run/fault_table.hpp"
#include "service/run/readiness.hpp"

namespace cell {
namespace {

std::string figure(std::optional<double> value, const char* format, const char* unknown = "-") {
  return value ? fmt::format(fmt::runtime(format), *value) : unknown;
}

std::string text(const std::optional<std::string>& value) { return value.value_or("-"); }

/// "grouped: r3 x 1.000"
std::string status_of(const Parameter& parameter) {
  if (!parameter.status) return "-";
  if (parameter.status == calib::ParameterStatus::kNoEffect) return "no effect";
  if (parameter.status != calib::ParameterStatus::kGrouped) return std::string(word_of(*parameter.status));
  std::string into;
  constexpr std::size_t kShown = 3;
  const std::vector<CarriedError>& factors = parameter.grouped_with;
  for (std::size_t i = 0; i < factors.size() && i < kShown; ++i) {
    into +=
        fmt::format("{}{} x {}", i == 0 ? "" : ", ", factors[i].name, figure(factors[i].factor, "{:.4g}"));
  }
  return fmt::format("grouped into {}{}", into, factors.size() > kShown ? ", ..." : "");
}

/// Half the width of the 95 % interval.
std::string half_width(const Parameter& parameter, const char* format) {
  if (!parameter.interval95) return "";
  const auto& [low, high] = *parameter.interval95;
  return low && high ? figure(0.5 * (*high - *low), format) : "";
}

std::string parameters_text(const std::vector<Parameter>& parameters) {
  std::string lines = fmt::format("{:<9}{:>12}{:>12}{:>12}  {:<5}{}\n", "error of", "nominal", "error",
                                  "+- (95 %)", "unit", "status");
  for (const Parameter& parameter : parameters) {
    const bool length = parameter.unit == "mm";
    lines += fmt::format("{:<9}{:>12}{:>12}{:>12}  {:<5}{}\n", parameter.name,
                         figure(parameter.nominal, length ? "{:.3f}" : "{:.5f}"),
                         figure(parameter.error, length ? "{:+.4f}" : "{:+.6f}"),
                         half_width(parameter, length ? "{:.4f}" : "{:.6f}"), parameter.unit,
                         status_of(parameter));
  }
  return lines;
}

std::string rejected_text(const ResultDocument& result) {
  std::string lines;
  for (const ResultDocument::RejectedTouch& touch : result.rejected_touches) {
    lines += fmt::format(
        "touch {} rejected: {}, {} mm off\n", touch.touch,
        touch.reason == calib::RejectionReason::kWrongFace ? "on another plane" : "does not fit the others",
        figure(touch.residual_mm, "{:+.3f}"));
  }
  return lines;
}

/// The test of all residuals, and the parts of the noise that it allows.
std::string tested_against(const ResultDocument::Fit& fit) {
  const std::string noise = figure(fit.lack_of_fit_noise_um, "{:.1f}");
  if (fit.lack_of_fit_test != "F") return fmt::format("chi-square test against the declared {} um", noise);
  return fmt::format("F test against {} um: {} um by repeats, {} um by the maker's figures of the gears",
                     noise, figure(fit.lack_of_fit_repeats_um, "{:.1f}"),
                     figure(fit.lack_of_fit_gears_um, "{:.1f}"));
}

/// Of what is touched more than once beside the reference place.
std::string repeats_text(const ResultDocument::RepeatsSource& source) {
  if (!source.noise_um || source.source == "reference_touches") return {};
  const bool two_speed = source.source == "two_speed";
  const char* what = two_speed                          ? "two contacts of a touch"
                     : source.source == "qualification" ? "qualification before the run"
                                                        : "touches made again";
  const char* unused =
      two_speed ? ", not counted: a lower bound" : ", not counted: other than the reference touches show";
  return fmt::format("{}: noise {} um ({} degrees of freedom{})\n", what, figure(source.noise_um, "{:.1f}"),
                     figure(source.degrees_of_freedom, "{:.0f}"), source.used ? "" : unused);
}

std::string fit_text(const ResultDocument::Fit& fit, const PlanePlaces& places) {
  std::string lines =
      fmt::format("noise of a touch: declared {} um, from the residuals {} um\n",
                  figure(fit.noise_declared_um, "{:.1f}"), figure(fit.noise_estimated_um, "{:.1f}"));
  if (fit.noise_repeats_um) {
    lines +=
        fmt::format("what was touched more than once: noise {} um ({} degrees of freedom)\n",
                    figure(fit.noise_repeats_um, "{:.1f}"), figure(fit.repeats_degrees_of_freedom, "{:.0f}"));
  }
  for (const ResultDocument::RepeatsSource& source : fit.repeats_sources) lines += repeats_text(source);
  if (!fit.lack_of_fit_p) return lines;
  lines += fmt::format("lack of fit: p = {} ({})", figure(fit.lack_of_fit_p, "{:.2g}"), tested_against(fit));
  const char* separator = "; plane";
  for (const ResultDocument::PlaneFit& plane : fit.planes) {
    lines += fmt::format("{} {} {}", separator, plane_text(plane.plane, places), figure(plane.p, "{:.2g}"));
    separator = ",";
  }
  lines += "\n";
  if (fit.droop_power) {
    lines += fmt::format(
        "droop that is not in the model: p = {} (F test, which finds {:.0f} of 100 droops of one "
        "standard deviation)\n",
        figure(fit.droop_p, "{:.2g}"), 100.0 * *fit.droop_power);
  }
  return lines;
}

std::string artefact_text(const std::vector<ArtefactParameter>& parameters) {
  if (parameters.empty()) return {};
  std::size_t width = 16;
  for (const ArtefactParameter& parameter : parameters) width = std::max(width, parameter.name.size() + 1);
  std::string lines = fmt::format("\n{:<{}}{:>12}{:>12}  {:<6}{}\n", "block and probe", width, "value",
                                  "+- (std)", "unit", "status");
  for (const ArtefactParameter& parameter : parameters) {
    const char* format = parameter.unit == "rad" ? "{:.6f}" : "{:.4f}";
    lines += fmt::format("{:<{}}{:>12}{:>12}  {:<6}{}\n", parameter.name, width,
                         figure(parameter.value, format), figure(parameter.std_uncertainty, format),
                         parameter.unit, parameter.status ? word_of(*parameter.status) : "-");
  }
  return lines;
}

/// The tip's expanded uncertainty over the workspace box: what an integrator asks for first.
std::string expanded_text(const TipDocument& tip) {
  std::string lines =
      fmt::format("\n{:<54}{:>9}{:>9}{:>9}\n",
                  fmt::format("uncertainty of the tip in the workspace box, k = {:g}", tip.expanded.k), "rms",
                  "95 %", "worst");
  const auto line = [&lines](const char* frame, const TipDocument::Expanded& expanded) {
    lines += fmt::format(
        "  {:<52}{:>9}{:>9}{:>9} mm\n", frame, figure(expanded.box_rms_mm, "{:.3f}", "unknown"),
        figure(expanded.box_p95_mm, "{:.3f}", "unknown"), figure(expanded.box_max_mm, "{:.3f}", "unknown"));
  };
  line("in the block's frame", tip.expanded);
  line("in the arm's own frame, without the block's place", tip.arm_frame.expanded);
  return lines;
}

/// The tip's uncertainty by source and by region.
std::string tip_text(const TipDocument& tip) {
  std::string lines = expanded_text(tip) + "\nstandard uncertainty of the tip, rms\n";
  const auto line = [&lines](const std::string& where, std::optional<double> value) {
    lines += fmt::format("  {:<34}{:>10} mm\n", where, figure(value, "{:.3f}", "unknown"));
  };
  line("at the block", tip.at_block_rms_mm);
  line("in the workspace box", tip.workspace_box_rms_mm);
  for (const TipDocument::Source& source : tip.sources)
    line("  from " + source.name, source.workspace_box_rms_mm);
  line("over the joint ranges", tip.joint_ranges_rms_mm);
  line("arm's frame, in the workspace box", tip.arm_frame.workspace_box_rms_mm);
  line("arm's frame, over the joint ranges", tip.arm_frame.joint_ranges_rms_mm);
  if (tip.warmer) {
    const std::string warmer = fmt::format("arm {:g} K warmer, ", tip.warmer->rise_k);
    line(warmer + "in the box", tip.warmer->workspace_box_rms_mm);
    line(warmer + "over the ranges", tip.warmer->joint_ranges_rms_mm);
  }
  for (const TipDocument::Tool& tool : tip.tools) {
    line(tool.name + ", in the workspace box", tool.workspace_box_rms_mm);
    line(tool.name + ", over the joint ranges", tool.joint_ranges_rms_mm);
  }
  return lines;
}

std::string monte_carlo_text(const ResultDocument::MonteCarlo& simulated) {
  return fmt::format(
      "\nMonte Carlo: {} of {} simulated calibrations converged; linear uncertainty over theirs {}\n"
      "standard uncertainty of the tip by them {} mm in the workspace box, {} mm over the joint ranges\n"
      "95 % of the tip errors in the box within {} mm\n",
      simulated.converged, simulated.count, figure(simulated.linear_over_monte_carlo, "{:.3f}", "unknown"),
      figure(simulated.box_rms_mm, "{:.3f}", "unknown"),
      figure(simulated.joint_ranges_rms_mm, "{:.3f}", "unknown"),
      figure(simulated.box_p95_mm, "{:.3f}", "unknown"));
}

std::string scale_text(const ResultDocument::Scale& scale) {
  return fmt::format("common scale of all lengths: from {}, +- {} ppm (std); they moved by {} ppm\n",
                     text(scale.source), figure(scale.std_uncertainty_ppm, "{:.0f}"),
                     figure(scale.stretch_ppm, "{:+.0f}"));
}

/// "  at stand, tip left  found at 150.512 mm": of a face that is estimated in place, there and with that
/// tip.
std::string where_of(const PlaneDistances& plane) {
  std::string words = where_in_row(plane.place, plane.tip);
  if (plane.estimated_offset_mm)
    words += fmt::format("  found at {} mm", figure(plane.estimated_offset_mm, "{:.3f}"));
  return words;
}

std::string planes_text(const std::vector<PlaneDistances>& planes, const char* title) {
  if (planes.empty()) return {};
  std::string lines =
      fmt::format("\n{}\n{:>5}{:>9}{:>13}{:>12}{:>14}{:>12}{:>14}{:>11}\n", title, "plane", "touches",
                  "reference", "nominal", "calibrated", "rms before", "rms after", "removed");
  for (const PlaneDistances& plane : planes) {
    lines += fmt::format("{:>5}{:>9}{:>10} mm{:>9} mm{:>11} mm{:>9} mm{:>11} mm{:>9} %{}\n", plane.plane,
                         plane.touch_count, figure(plane.reference_mm, "{:.3f}"),
                         figure(plane.nominal_mean_mm, "{:.3f}"), figure(plane.calibrated_mean_mm, "{:.3f}"),
                         figure(plane.nominal_rms_mm, "{:.3f}"), figure(plane.calibrated_rms_mm, "{:.3f}"),
                         figure(plane.error_removed_percent, "{:.2f}"), where_of(plane));
  }
  return lines;
}

/// What the verdict is made of.
std::string limits_text(const DecisionRuleDocument& rule, const PlanePlaces& places) {
  constexpr const char* kColumns = "{:<{}}{:>11}{:>17}{:>10}  {}\n";
  const std::vector<LimitRow> rows = limit_rows(rule, places);
  std::size_t width = 23;
  for (const LimitRow& row : rows) width = std::max(width, row.criterion.size() + 1);
  std::string lines =
      "\n" + fmt::format(kColumns, rule.rule.empty() ? "limits" : "limits (" + rule.rule + " rule)", width,
                         "value", "limit", "+- U", "decision");
  for (const LimitRow& row : rows)
    lines += fmt::format(kColumns, row.criterion, width, row.value, row.limit, row.expanded_uncertainty,
                         row.decision);
  return lines;
}

}  // namespace

std::string result_text(const ResultDocument& result) {
  const PlanePlaces places = plane_places_of(result);
  std::string lines = parameters_text(result.parameters);
  lines += fmt::format("\n{} of {} parameters identified from {} touches in {} iterations\n",
                       figure(result.identifiable_count, "{:.0f}"), result.parameters.size(),
                       figure(result.touch_count, "{:.0f}"), result.iterations.size());
  lines += "condition number, iteration by iteration:";
  for (const ResultDocument::Iteration& iteration : result.iterations)
    lines += " " + figure(iteration.condition_number, "{:.1f}");
  lines += fmt::format(" (columns of unit norm: {})\n", figure(result.scaled_condition_number, "{:.1f}"));
  if (result.rank.singular_value_gap)
    lines += fmt::format("smallest singular value kept over the next one: {}\n",
                         figure(result.rank.singular_value_gap, "{:.3g}"));
  if (!result.rank.explanation.empty())
    lines += fmt::format("not more of them: {}\n", result.rank.explanation);
  lines += fit_text(result.fit, places);
  lines += scale_text(result.scale);
  lines += rejected_text(result);
  lines += artefact_text(result.artefact_parameters);
  if (result.model_reason) lines += *result.model_reason + '\n';
  for (const NongeometricParameter& parameter : result.nongeometric_parameters) {
    lines += fmt::format("{}: {} +- {} {}\n", parameter.name, figure(parameter.value, "{:.3g}"),
                         figure(parameter.std_uncertainty, "{:.2g}"), parameter.unit);
  }
  lines += tip_text(result.tip_uncertainty);
  if (result.monte_carlo) lines += monte_carlo_text(*result.monte_carlo);
  lines += planes_text(result.planes, "distances of the fitted touches from the block's origin");
  lines += planes_text(result.planes_held_out, "distances of the held-out touches");
  lines += planes_text(result.planes_proof, "distances of the proof touches");
  const std::vector<std::string>& reasons = result.verdict.reasons;
  for (const std::string& warning : result.warnings) {
    if (std::ranges::find(reasons, warning) == reasons.end())
      lines += fmt::format("\nwarning: {}\n", warning);
  }
  if (result.verdict.decision_rule) lines += limits_text(*result.verdict.decision_rule, places);
  lines += result.verdict.accepted ? "\nverdict: accepted\n" : "\nverdict: rejected\n";
  for (const std::string& reason : reasons) lines += fmt::format("  - {}\n", reason);
  return lines;
}

/// Nothing for a sink that is not configured.
std::string sink_text(const char* name, const std::optional<std::int64_t>& behind,
                      const std::optional<std::string>& trouble) {
  if (!behind) return "";
  return fmt::format("{:<12}{} facts behind{}\n", name, *behind, trouble ? ": " + *trouble : "");
}

std::string status_text(const StatusDocument& status) {
  const auto text_or_unknown = [](const std::optional<std::string>& value) {
    return value.value_or("unknown");
  };
  std::string lines = fmt::format("state       {}\n", word_of(status.state));
  const auto yes_no = [](std::optional<bool> value, const char* yes, const char* no) {
    return value ? (*value ? yes : no) : "unknown";
  };
  std::optional<double> data_age_ms;
  if (status.live.data_age_ms) data_age_ms = static_cast<double>(*status.live.data_age_ms);
  lines += fmt::format(
      "controller  {}, power {}, mode {}, emergency stop {}, data {} ms old\n"
      "cell        {}, touch test {}, probe {}, permit {}\n",
      status.controller_connected ? "connected" : "not connected",
      yes_no(status.controller_powered, "on", "off"), text_or_unknown(status.controller_mode),
      yes_no(status.controller_estop, "ACTIVE", "none"), figure(data_age_ms, "{:.0f}", "?"),
      yes_no(status.controller_cell_closed, "closed", "OPEN"),
      yes_no(status.controller_touch_tested, "made", "missing"), text_or_unknown(status.probe),
      text_or_unknown(status.controller_permit));
  if (status.retract_due.value_or(false))
    lines +=
        "arm         at a face; it is taken back before anything else: by touchcal resume where a run is on "
        "hold, else by touchcal reset\n";
  if (status.waiting_for) lines += fmt::format("waiting     {}\n", awaited_instruction(*status.waiting_for));
  if (status.run_id) {
    lines += fmt::format(
        "run         {} ({}), {} of {} touches, {} identifiable, condition number {}, tip +- {} mm, verdict "
        "{}\n",
        *status.run_id, text(status.recipe), status.touches_done, figure(status.touches_total, "{:.0f}"),
        figure(status.identifiable_count, "{:.0f}"), figure(status.condition_number, "{:.0f}"),
        figure(status.predicted_tip_rms_mm, "{:.3f}"), word_of(status.verdict));
  }
  lines += more_text(status);
  lines += sink_text("broker", status.live.mqtt_behind, status.live.mqtt_trouble);
  lines += sink_text("archive", status.live.archive_behind, status.live.archive_trouble);
  if (status.block_place && !is_block_to_move(status))
    lines += fmt::format("block       at {}\n", *status.block_place);
  if (is_block_to_move(status)) {
    lines += fmt::format("to do       {}\n  robot     {}\n  next      {}\n", text(status.fault_message),
                         text(status.fault_robot_action), text(status.fault_next_step));
  } else if (status.fault_code) {
    lines += fmt::format("fault       {}: {}\n  robot     {}\n  next      {}\n", *status.fault_code,
                         text(status.fault_message), text(status.fault_robot_action),
                         text(status.fault_next_step));
  }
  return lines;
}

bool is_block_to_move(const StatusDocument& status) {
  return status.state == State::kHeld && status.fault_code == describe(FaultCode::kBlockToMove).name;
}

std::string more_text(const StatusDocument& status) {
  return status.touch_benefit ? fmt::format("more        {}\n", *status.touch_benefit) : "";
}

namespace {

/// "quick" of a calibration, "check of 3", "qualification".
std::string what_of(const RunSummary& run) {
  if (run.kind == "calibration") return run.recipe;
  return run.of_run ? fmt::format("{} of {}", run.kind, *run.of_run) : run.kind;
}

}  // namespace

std::string runs_text(const std::vector<RunSummary>& runs) {
  std::string lines = fmt::format("{:<6}{:<20}{:<13}{:<12}{:>11}  {:<26}{}\n", "run", "what", "outcome",
                                  "verdict", "touches", "started", "fault");
  for (const RunSummary& run : runs) {
    lines += fmt::format("{:<6}{:<20}{:<13}{:<12}{:>11}  {:<26}{}\n", run.id, what_of(run),
                         word_of(run.outcome), word_of(run.verdict),
                         fmt::format("{}/{}", run.touches_done, figure(run.touches_total, "{:.0f}")),
                         run.started_at, run.fault_code.value_or(""));
  }
  return lines;
}

}  // namespace cell
