#include "service/run/decision_rule.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/distributions.hpp"

namespace cell {

using calib::mm_from_metres;

namespace {

using Criteria = std::vector<Criterion>;

std::optional<double> in_mm(std::optional<double> metres) {
  return metres ? std::optional(mm_from_metres(*metres)) : std::nullopt;
}

/// What is so or not: 1 or 0, and 1 is wanted.
void add_condition(const char* name, bool holds, std::string miss, Criteria& list) {
  list.push_back({.name = name,
                  .unit = "1",
                  .value = holds ? 1.0 : 0.0,
                  .limit = 1.0,
                  .at_least = true,
                  .miss = std::move(miss)});
}

void add_held_out_count(const calib::IdentificationResult& result, Criteria& list) {
  int count = 0;
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role == calib::TouchRole::kHeldOut) count += face.touch_count;
  }
  list.push_back({.name = "held_out_touches",
                  .unit = "1",
                  .value = count,
                  .limit = 1.0,
                  .at_least = true,
                  .miss = "no touch was held out: nothing is proved of the limits for them; hold some out"});
}

void add_tip(const JudgedTip& tip, const Cell& cell, const std::string& recipe, Criteria& list) {
  const auto add = [&](const char* name, const char* what, std::optional<double> value_m, double limit_m,
                       std::optional<std::string> tool = std::nullopt) {
    const std::string of = tool ? fmt::format(" of the tool {}", *tool) : "";
    list.push_back(
        {.name = name,
         .tool = tool,
         .unit = "mm",
         .value = in_mm(value_m),
         .limit = mm_from_metres(limit_m),
         .miss = value_m ? fmt::format("the predicted {}{} in the workspace box is {:.3f} mm, the limit is "
                                       "{:.3f} mm",
                                       what, of, mm_from_metres(*value_m), mm_from_metres(limit_m))
                         : fmt::format("the {}{} in the workspace box is unknown, the limit is {:.3f} mm",
                                       what, of, mm_from_metres(limit_m))});
  };
  if (const auto limit_m = cell.acceptance.tip_box_rms_max_m)
    add("tip_box_rms", "tip uncertainty", tip.box_rms_m, *limit_m);
  if (const auto limit_m = cell.acceptance.tip_box_max_of_m(recipe))
    add("tip_box_max", "largest expanded tip uncertainty (k = 2)", tip.box_max_m, *limit_m);
  for (const JudgedTip::OfTool& tool : tip.tools) {
    const auto limit = cell.acceptance.tool_box_rms_max_m.find(tool.name);
    if (limit != cell.acceptance.tool_box_rms_max_m.end())
      add("tool_box_rms", "tip uncertainty", tool.box_rms_m, limit->second, tool.name);
  }
}

/// A calibration must say more of the tip than what the cell's file assumes of the uncalibrated arm.
void add_gain(const JudgedTip& tip, const Cell& cell, Criteria& list) {
  std::vector<std::string> names;
  for (const int index : tip.unknown_errors) names.push_back(calib::arm_parameter_name(index));
  list.push_back(
      {.name = "unknown_errors",
       .unit = "1",
       .value = static_cast<double>(names.size()),
       .limit = 0.0,
       .miss = fmt::format("no touch shows {0} and the arm's file has no std for {1}: the tip may be "
                           "off by any amount; touch a face that shows {1}, or give \"std\" of {1}",
                           fmt::join(names, ", "), names.size() == 1 ? "it" : "them")});
  if (!names.empty()) return;  // any figure of the tip would mislead
  const double limit_mm = mm_from_metres(cell.nominal_position_error_m);
  const std::string known =
      tip.box_max_m ? fmt::format("{:.3f} mm", mm_from_metres(*tip.box_max_m)) : "unknown";
  list.push_back(
      {.name = "nominal_miss",
       .unit = "mm",
       .value = in_mm(tip.box_max_m),
       .limit = limit_mm,
       .miss = fmt::format("the largest expanded tip uncertainty (k = 2) in the workspace box is {}, "
                           "but the uncalibrated arm misses by no more than {:.3f} mm "
                           "(nominal_miss_mm): this says less of the tip than was known before; touch "
                           "faces in every direction whose place is known",
                           known, limit_mm)});
}

void add_scale(const calib::IdentificationResult& result, Criteria& list) {
  if (!result.scale) return;
  const calib::ScaleCheck& scale = *result.scale;
  const bool of_artefact = scale.contradicted.has_value();
  if (scale.significance || (!scale.warning.empty() && !of_artefact)) {
    list.push_back({.name = "scale",
                    .unit = "1",
                    .value = scale.significance,
                    .limit = calib::kScaleSignificanceMax,
                    .miss = scale.warning});
  }
  if (of_artefact) {
    list.push_back({.name = "artefact",
                    .unit = "1",
                    .value = scale.contradicted,
                    .limit = calib::kArtefactSignificanceMax,
                    .miss = scale.warning});
  }
}

void add_condition_number(const calib::IdentificationResult& result, const Cell& cell, Criteria& list) {
  const double limit = cell.acceptance.condition_number_max;
  if (result.iterations.empty()) return;  // it did not converge, which is a reason of its own
  const double value = result.iterations.back().condition_number;
  list.push_back({.name = "condition_number",
                  .unit = "1",
                  .value = value,
                  .limit = limit,
                  .miss = fmt::format("the condition number is {:.0f}, the limit {:.0f}", value, limit)});
}

void add_lack_of_fit(const calib::IdentificationResult& result, const Cell& cell, Criteria& list) {
  if (!result.lack_of_fit) return;
  const double limit = cell.acceptance.lack_of_fit_p_min;
  const auto faces = static_cast<double>(result.lack_of_fit->p_of_face.size());
  for (std::size_t face = 0; face < result.lack_of_fit->p_of_face.size(); ++face) {
    const double p = result.lack_of_fit->p_of_face[face];
    list.push_back(
        {.name = "lack_of_fit",
         .plane = static_cast<int>(face) + 1,
         .unit = "1",
         .value = p,
         .limit = limit / faces,  // one plane of several is unlikely by chance that much more often
         .at_least = true,
         .miss = fmt::format("lack of fit on plane {}: its residuals exceed the noise of a touch (p = "
                             "{:.1g}); check this face",
                             face + 1, p)});
  }
  list.push_back(
      {.name = "lack_of_fit",
       .unit = "1",
       .value = result.lack_of_fit->p,
       .limit = limit,
       .at_least = true,
       .miss = fmt::format("lack of fit: the residuals exceed {} (they show {:.1f} um instead of {:.1f}; p = "
                           "{:.1g}, the limit is "
                           "{:g}): an effect is missing in the model",
                           result.lack_of_fit->is_f_test() ? "what repeated touches and the gears explain"
                                                           : "the declared touch noise",
                           1e3 * mm_from_metres(result.noise_estimated_m.value_or(0.0)),
                           1e3 * mm_from_metres(result.lack_of_fit->noise_m), result.lack_of_fit->p, limit)});
}

void add_rejected(const calib::IdentificationResult& result, Criteria& list) {
  const auto rejected = static_cast<int>(result.rejected.size());
  const int touches = result.fitted_touch_count + rejected;
  if (touches == 0) return;
  list.push_back({.name = "rejected_touches",
                  .unit = "1",
                  .value = static_cast<double>(rejected) / touches,
                  .limit = kRejectedShareMax,
                  .miss = fmt::format("{} of {} touches were rejected, more than {:.0f} %", rejected, touches,
                                      100.0 * kRejectedShareMax)});
}

std::vector<std::string> held_parameters(const calib::IdentificationResult& result,
                                         const calib::IdentificationOptions& options) {
  std::vector<std::string> held;
  for (int i = 0; i < calib::kErrorParameterCount; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (result.identifiable.candidates[index].status == calib::ParameterStatus::kWeak &&
        !is_estimated(options, result.identifiable, i))
      held.push_back(calib::error_parameters()[index].name());
  }
  return held;
}

void add_set(const calib::IdentificationResult& result, const calib::IdentificationOptions& options,
             Criteria& list) {
  if (options.prior) {
    const auto shown = static_cast<int>(result.identifiable.columns.size());
    list.push_back(
        {.name = "shown_parameters",
         .unit = "1",
         .value = shown,
         .limit = static_cast<double>(result.attainable.count),
         .at_least = true,
         .miss = fmt::format("incomplete set: the touches show {} of {} parameters, the prior gives the rest",
                             shown, result.attainable.count)});
    return;
  }
  const std::vector<std::string> held = held_parameters(result, options);
  list.push_back(
      {.name = "held_parameters",
       .unit = "1",
       .value = static_cast<double>(held.size()),
       .limit = 0.0,
       .miss = fmt::format("incomplete set: these touches barely determine {}", fmt::join(held, ", "))});
}

void add_held_out(const calib::FaceDistances& face, const Cell& cell, Criteria& list) {
  const int plane = face.face + 1;
  const double mean_max = mm_from_metres(cell.acceptance.held_out_mean_max_m);
  const double rms_max = mm_from_metres(cell.acceptance.held_out_rms_max_m);
  const double rms = mm_from_metres(face.calibrated_rms_m);
  list.push_back({.name = "held_out_mean",
                  .plane = plane,
                  .unit = "mm",
                  .value = mm_from_metres(std::abs(face.calibrated_mean_m)),
                  .limit = mean_max,
                  .expanded_uncertainty = face.calibrated_mean_std_m
                                              ? in_mm(kCoverageFactor * *face.calibrated_mean_std_m)
                                              : std::nullopt,
                  .is_measured = true,
                  .miss = fmt::format("held-out touches on plane {} are off by {:.3f} mm in the mean, the "
                                      "limit is {:.3f} mm",
                                      plane, mm_from_metres(face.calibrated_mean_m), mean_max)});
  // The true rms is at most this, as often as a normal figure is under its value and k standard deviations.
  const double n = face.touch_count;
  const double outside = (1.0 - calib::normal_two_sided_confidence(kCoverageFactor)) / 2.0;
  const double bound = rms * std::sqrt(n / calib::chi_square_quantile(outside, n));
  list.push_back(
      {.name = "held_out_rms",
       .plane = plane,
       .unit = "mm",
       .value = rms,
       .limit = rms_max,
       .expanded_uncertainty = bound - rms,
       .is_measured = true,
       .miss = fmt::format("held-out touches on plane {} scatter by {:.3f} mm rms, the limit is {:.3f} mm",
                           plane, rms, rms_max)});
}

}  // namespace

// Every comparison is written so that NaN misses its limit.

bool Criterion::within_limit() const { return value && (at_least ? *value >= limit : *value <= limit); }

std::optional<bool> Criterion::proved() const {
  if (!expanded_uncertainty) return std::nullopt;
  if (!value) return false;
  return at_least ? *value - *expanded_uncertainty >= limit : *value + *expanded_uncertainty <= limit;
}

JudgedTip judged_tip(const TipPrediction& tip) {
  JudgedTip judged{.box_rms_m = tip.workspace_box_rms_m,
                   .box_max_m = tip.expanded.box_max_m,
                   .unknown_errors = tip.unknown_errors};
  for (const TipPrediction::OfTool& tool : tip.tools)
    judged.tools.push_back({tool.name, tool.workspace_box_rms_m});
  return judged;
}

bool is_estimated(const calib::IdentificationOptions& options, const calib::IdentifiableSet& identifiable,
                  int index) {
  const calib::ParameterStatus status = identifiable.candidates[static_cast<std::size_t>(index)].status;
  return options.prior ? status != calib::ParameterStatus::kExcluded
                       : status == calib::ParameterStatus::kIdentified;
}

std::vector<Criterion> criteria(const calib::IdentificationResult& result, const Recipe& recipe,
                                const Cell& cell, const JudgedTip& tip, bool complete) {
  Criteria list;
  const bool converged = result.status == calib::IdentificationStatus::kConverged;
  add_condition("complete", complete, "the run was not completed", list);
  add_condition("converged", converged, result.message, list);
  if (converged) {
    add_tip(tip, cell, recipe.name, list);
    add_gain(tip, cell, list);
  }
  add_scale(result, list);
  add_condition_number(result, cell, list);
  add_lack_of_fit(result, cell, list);
  add_rejected(result, list);
  add_set(result, recipe.identification, list);
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role == calib::TouchRole::kHeldOut) add_held_out(face, cell, list);
  }
  if (cell.acceptance.guarded) add_held_out_count(result, list);
  return list;
}

}  // namespace cell
