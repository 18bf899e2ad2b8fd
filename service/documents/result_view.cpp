#include "service/documents/result_view.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/geometry/units.hpp"
#include "calib_core/identification/face_distances.hpp"
#include "calib_core/identification/validate.hpp"
#include "config/touched_places.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/decision_rule_view.hpp"
#include "service/documents/figures.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/validation_view.hpp"
#include "service/run/verdict.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

std::optional<double> micrometres(std::optional<double> value_m) {
  return value_m ? finite(1e3 * mm_from_metres(*value_m)) : std::nullopt;
}

std::optional<double> parts_per_million(double relative) { return finite(1e6 * relative); }

ResultDocument::Iteration iteration_of(const calib::Iteration& iteration) {
  return {.condition_number = finite(iteration.condition_number),
          .scaled_condition_number = finite(iteration.scaled_condition_number),
          .residual_rms_mm = finite_mm(iteration.residual_rms_m),
          .step_norm = finite(iteration.step_norm)};
}

ResultDocument::RejectedTouch rejected_of(const calib::RejectedTouch& touch) {
  return {.touch = static_cast<int>(touch.touch) + 1,
          .residual_mm = finite_mm(touch.residual_m),
          .reason = touch.reason};
}

const char* source_name(calib::ScaleSource source) {
  switch (source) {
    case calib::ScaleSource::kBlock:
      return "block";
    case calib::ScaleSource::kTwoLengths:
      return "two_lengths";
    case calib::ScaleSource::kPrior:
      return "prior";
  }
  return "";
}

ResultDocument::Scale scale_of(const std::optional<calib::ScaleCheck>& scale) {
  if (!scale) return {};
  ResultDocument::Scale document{.source = source_name(scale->source),
                                 .std_uncertainty_ppm = parts_per_million(scale->std_relative),
                                 .stretch_ppm = parts_per_million(scale->stretch_relative),
                                 .significance = finite(scale->significance)};
  if (!scale->warning.empty()) document.warning = scale->warning;
  return document;
}

std::array<double, 3> millimetres(const Eigen::Vector3d& vector_m) {
  return {mm_from_metres(vector_m.x()), mm_from_metres(vector_m.y()), mm_from_metres(vector_m.z())};
}

TipDocument::Map map_of(const Cell& cell, const calib::UncertaintyMap& map) {
  const Eigen::Vector3d& min_m = map.grid.min_m;
  const Eigen::Vector3d extent_m(map.grid.cell_size_m.x() * map.grid.counts[0],
                                 map.grid.cell_size_m.y() * map.grid.counts[1],
                                 map.grid.cell_size_m.z() * map.grid.counts[2]);
  TipDocument::Map document{
      .box = {cell.workspace_box.name, millimetres(min_m), millimetres(min_m + extent_m)},
      .counts = map.grid.counts,
      .cell_mm = millimetres(map.grid.cell_size_m)};
  for (const auto& rms_m : map.rms_m) document.values_mm.push_back(finite_mm(rms_m));
  return document;
}

TipDocument::Expanded expanded_of(const TipPrediction::Expanded& expanded) {
  return {.box_rms_mm = finite_mm(expanded.box_rms_m),
          .box_p95_mm = finite_mm(expanded.box_p95_m),
          .box_max_mm = finite_mm(expanded.box_max_m)};
}

TipDocument::ArmFrame arm_frame_of(const TipPrediction::InArmFrame& tip) {
  return {.at_block_rms_mm = finite_mm(tip.at_block_rms_m),
          .workspace_box_rms_mm = finite_mm(tip.workspace_box_rms_m),
          .joint_ranges_rms_mm = finite_mm(tip.joint_ranges_rms_m),
          .expanded = expanded_of(tip.expanded)};
}

/// A plane without fitted touches has no p.
std::vector<ResultDocument::PlaneFit> plane_fits_of(const calib::IdentificationResult& result) {
  std::vector<ResultDocument::PlaneFit> planes;
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role != calib::TouchRole::kFit || !result.lack_of_fit) continue;
    const double p = result.lack_of_fit->p_of_face.at(static_cast<std::size_t>(face.face));
    planes.push_back({.plane = face.face + 1, .p = finite(p)});
  }
  return planes;
}

std::vector<ResultDocument::RepeatsSource> repeats_sources_of(const calib::RepeatSources& sources) {
  std::vector<ResultDocument::RepeatsSource> all;
  const auto add = [&all](const char* name, const calib::RepeatSource& source) {
    auto& entry = all.emplace_back(
        ResultDocument::RepeatsSource{.source = name, .noise_um = {}, .degrees_of_freedom = {}});
    if (!source.noise) return;
    entry.noise_um = micrometres(source.noise->std_m);
    entry.degrees_of_freedom = source.noise->degrees_of_freedom;
    entry.used = source.used;
  };
  add("reference_touches", sources.reference_touches);
  add("two_speed", sources.two_speed);
  add("touched_again", sources.touched_again);
  if (sources.qualification.noise) add("qualification", sources.qualification);
  return all;
}

ResultDocument::Fit fit_of(const calib::IdentificationProblem& problem,
                           const calib::IdentificationResult& result) {
  const auto& lack_of_fit = result.lack_of_fit;
  const auto& uncertainty = result.uncertainty;
  ResultDocument::Fit document{.noise_estimated_um = micrometres(result.noise_estimated_m),
                               .planes = plane_fits_of(result)};
  if (problem.touch_noise_m > 0.0) document.noise_declared_um = micrometres(problem.touch_noise_m);
  if (problem.pure_error) {
    document.noise_repeats_um = micrometres(problem.pure_error->std_m);
    document.repeats_degrees_of_freedom = problem.pure_error->degrees_of_freedom;
  }
  document.repeats_sources = repeats_sources_of(problem.repeat_sources);
  if (uncertainty) {
    document.noise_used_um = micrometres(uncertainty->noise_m);
    if (!problem.gear_std_rad.isZero(0.0)) document.gear_share = finite(uncertainty->gear_share);
  }
  if (lack_of_fit) {
    document.lack_of_fit_test = lack_of_fit->is_f_test() ? "F" : "chi_square";
    document.lack_of_fit_noise_um = micrometres(lack_of_fit->noise_m);
    if (lack_of_fit->is_f_test()) {
      document.lack_of_fit_repeats_um = micrometres(lack_of_fit->repeats_m);
      document.lack_of_fit_gears_um = micrometres(lack_of_fit->gears_m);
    }
    if (lack_of_fit->droop) {
      document.droop_p = finite(lack_of_fit->droop->p);
      document.droop_power = finite(lack_of_fit->droop->power(calib::kDroopShownP));
    }
    document.lack_of_fit_p = finite(lack_of_fit->p);
    document.degrees_of_freedom = finite(lack_of_fit->degrees_of_freedom);
  } else if (uncertainty) {
    document.degrees_of_freedom = finite(uncertainty->degrees_of_freedom);
  }
  return document;
}

/// The touches that the choice of columns was made with: outliers were found after it.
std::vector<std::size_t> chosen_with(const calib::IdentificationProblem& problem,
                                     const calib::IdentificationResult& result) {
  std::vector<std::size_t> touches;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const bool is_on_another =
        std::ranges::any_of(result.rejected, [&](const calib::RejectedTouch& rejected) {
          return rejected.touch == i && rejected.reason == calib::RejectionReason::kWrongFace;
        });
    if (problem.touches[i].role == calib::TouchRole::kFit && !is_on_another) touches.push_back(i);
  }
  return touches;
}

ResultDocument::Rank rank_of(const calib::IdentificationProblem& problem,
                             const calib::IdentificationOptions& options,
                             const calib::IdentificationResult& result) {
  ResultDocument::Rank rank{.attainable = result.attainable.count,
                            .off_axis = result.attainable.off_axis_count,
                            .explanation = result.rank_explanation,
                            .smallest_kept = finite(result.identifiable.smallest_kept),
                            .largest_dropped = finite(result.identifiable.largest_dropped)};
  const std::size_t count = result.identifiable.columns.size();
  if (count == 0) return rank;  // refused before the choice, perhaps for a touch that cannot be
  rank.singular_values = calib::choice_singular_values(problem, options, chosen_with(problem, result));
  if (count < rank.singular_values.size())
    rank.singular_value_gap = finite(rank.singular_values[count - 1] / rank.singular_values[count]);
  return rank;
}

/// What distances count from: a plane's from the origin along its outward normal, a sphere's from its centre.
/// A bore's count from its axis along the outward normal, which points to the axis: its wall is at minus its
/// radius, and larger is farther out of the material as elsewhere.
double reference_of(const Cell& cell, int face) {
  const calib::Face& touched = face_of_block(cell.block, face);
  if (touched.is_flat()) return touched.plane.offset_m;
  return (touched.bore ? -1.0 : 1.0) * surface_of(touched).radius_m();
}

/// Distances are reference + signed distance. Those of the
/// calibrated arm from a face that was found in place begin at its found offset, so that the mean is against
/// the reference as for the other faces, and not against what the same touches estimated.
PlaneDistances plane_of(const Cell& cell, const Recipe& recipe, const calib::FaceDistances& face) {
  const double reference = reference_of(cell, face.face);
  const double calibrated = face.calibrated_mean_m + face.found_offset_m.value_or(0.0);
  const auto percent = [](double part, double whole) {
    return whole == 0.0 ? std::nullopt : finite(100.0 * (1.0 - std::abs(part) / std::abs(whole)));
  };
  return {
      .plane = face.face + 1,
      .place = further_place_name(cell.block, recipe, face.face),
      .tip = further_tip_name(cell, recipe, face.face),
      .touch_count = face.touch_count,
      .reference_mm = finite_mm(reference),
      .estimated_offset_mm = face.found_offset_m ? finite_mm(reference + *face.found_offset_m) : std::nullopt,
      .nominal_mean_mm = finite_mm(reference + face.nominal_mean_m),
      .calibrated_mean_mm = finite_mm(reference + calibrated),
      .error_removed_percent = percent(calibrated, face.nominal_mean_m),
      .nominal_agreement_percent = percent(face.nominal_mean_m, reference),
      .nominal_rms_mm = finite_mm(face.nominal_rms_m),
      .calibrated_rms_mm = finite_mm(face.calibrated_rms_m)};
}

TouchUse use_of(const calib::IdentificationResult& result, std::size_t touch) {
  const auto found = std::ranges::find(result.rejected, touch, &calib::RejectedTouch::touch);
  return found == result.rejected.end() ? TouchUse::kUsed : TouchUse::kRejected;
}

/// Distances as those of the planes.
std::vector<ResultDocument::TouchDistances> touches_of(const Cell& cell,
                                                       const calib::IdentificationProblem& problem,
                                                       const calib::IdentificationResult& result) {
  std::vector<ResultDocument::TouchDistances> list;
  if (result.status != calib::IdentificationStatus::kConverged) return list;
  const auto distances = calib::touch_distances(problem, result);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const calib::Touch& touch = problem.touches[i];
    const auto face = static_cast<std::size_t>(touch.face);
    const double reference = reference_of(cell, touch.face);
    const double found = reference + calib::found_offset_m(problem, result, face).value_or(0.0);
    list.push_back({.touch = static_cast<int>(i) + 1,
                    .plane = touch.face + 1,
                    .role = touch.role,
                    .use = use_of(result, i),
                    .nominal_mm = finite_mm(reference + distances[i].nominal_m),
                    .calibrated_mm = finite_mm(found + distances[i].calibrated_m)});
  }
  return list;
}

/// Absent before the touches are complete: a repetition needs all of them.
std::optional<RepetitionsDocument> validation_of(const calib::IdentificationProblem& problem,
                                                 const calib::IdentificationOptions& options,
                                                 const calib::IdentificationResult& result, bool complete,
                                                 const std::vector<Parameter>& parameters) {
  if (!complete || result.status != calib::IdentificationStatus::kConverged) return std::nullopt;
  return repetitions_of(parameters, calib::validate(problem, options, result));
}

}  // namespace

TipDocument tip_of(const Cell& cell, const TipPrediction& tip) {
  TipDocument document{.at_block_rms_mm = finite_mm(tip.at_block_rms_m),
                       .workspace_box_rms_mm = finite_mm(tip.workspace_box_rms_m),
                       .joint_ranges_rms_mm = finite_mm(tip.joint_ranges_rms_m),
                       .expanded = expanded_of(tip.expanded),
                       .arm_frame = arm_frame_of(tip.arm_frame)};
  if (tip.warmer) {
    document.warmer = TipDocument::Warmer{.rise_k = tip.warmer->rise_k,
                                          .workspace_box_rms_mm = finite_mm(tip.warmer->workspace_box_rms_m),
                                          .joint_ranges_rms_mm = finite_mm(tip.warmer->joint_ranges_rms_m)};
  }
  for (const TipPrediction::OfSource& source : tip.sources)
    document.sources.push_back({source.name, finite_mm(source.workspace_box_rms_m)});
  for (const TipPrediction::OfTool& tool : tip.tools) {
    document.tools.push_back(
        {tool.name, finite_mm(tool.workspace_box_rms_m), finite_mm(tool.joint_ranges_rms_m)});
  }
  if (tip.map) document.map = map_of(cell, *tip.map);
  return document;
}

std::vector<PlaneDistances> planes_of(const Cell& cell, const Recipe& recipe,
                                      const std::vector<calib::FaceDistances>& distances,
                                      calib::TouchRole role) {
  std::vector<PlaneDistances> planes;
  for (const calib::FaceDistances& face : distances) {
    if (face.role == role) planes.push_back(plane_of(cell, recipe, face));
  }
  return planes;
}

ResultDocument result_of(const TipRegions& regions, const Recipe& recipe,
                         const calib::IdentificationProblem& problem,
                         const calib::IdentificationResult& result, const ResultContext& context) {
  const Cell& cell = regions.cell();
  const calib::IdentificationOptions& options = recipe.identification;
  ResultDocument document{
      .arm = cell.arm.name,
      .recipe = recipe.name,
      .touch_count = result.fitted_touch_count,
      .complete = context.complete,
      .cell_frames = cell.own_frames,
      .warnings = result.warnings,
      .converged = result.status == calib::IdentificationStatus::kConverged,
      .identifiable_count = static_cast<int>(result.identifiable.columns.size()),
      .singular_values = result.singular_values,
      .rank = rank_of(problem, options, result),
      .parameters = parameters_of(problem, options, result),
      .correlations = correlations_of(result),
      .artefact_parameters = artefact_parameters_of(problem, result),
      .nongeometric_parameters = nongeometric_parameters_of(problem, result),
      .planes = planes_of(cell, recipe, result.distances, calib::TouchRole::kFit),
      .planes_held_out = planes_of(cell, recipe, result.distances, calib::TouchRole::kHeldOut),
      .planes_proof = planes_of(cell, recipe, result.distances, calib::TouchRole::kProof),
      .touches = touches_of(cell, problem, result),
      .scale = scale_of(result.scale),
      .fit = fit_of(problem, result)};
  for (const NongeometricParameter& parameter : document.nongeometric_parameters)
    document.model.push_back(parameter.name);
  if (!result.model_reason.empty()) document.model_reason = result.model_reason;
  document.stiffness = stiffness_of(document.nongeometric_parameters, result);
  std::ranges::copy(context.warnings, std::back_inserter(document.warnings));
  std::ranges::transform(result.rejected, std::back_inserter(document.rejected_touches), rejected_of);
  std::ranges::transform(result.iterations, std::back_inserter(document.iterations), iteration_of);
  if (!document.iterations.empty()) {
    document.condition_number = document.iterations.back().condition_number;
    document.scaled_condition_number = document.iterations.back().scaled_condition_number;
  }
  document.validation = validation_of(problem, options, result, context.complete, document.parameters);
  const TipPrediction tip = predict_tip(regions, problem, result);
  document.tip_uncertainty = tip_of(cell, tip);
  if (context.monte_carlo) add_monte_carlo(*context.monte_carlo, document);
  const std::vector<Criterion> judged = criteria(result, recipe, cell, judged_tip(tip), context.complete);
  Judgement judgement = judge(judged, cell.acceptance);
  document.verdict = {.accepted = judgement.accepted,
                      .reasons = std::move(judgement.reasons),
                      .decision_rule = decision_rule_of(judged, cell.acceptance)};
  document.conditions.text = context.conditions.empty() ? conditions_document(cell, {}) : context.conditions;
  return document;
}

void add_monte_carlo(const calib::MonteCarloFigures& figures, ResultDocument& document) {
  document.monte_carlo = {.count = figures.count,
                          .converged = figures.converged,
                          .box_rms_mm = finite_mm(figures.box_rms_m),
                          .box_p95_mm = finite_mm(figures.box_p95_m),
                          .joint_ranges_rms_mm = finite_mm(figures.joint_ranges_rms_m),
                          .linear_over_monte_carlo = finite(figures.linear_over_monte_carlo)};
  if (!figures.warning.empty()) document.warnings.push_back(figures.warning);
}

std::string result_document(const TipRegions& regions, const Recipe& recipe,
                            const calib::IdentificationProblem& problem,
                            const calib::IdentificationResult& result, const ResultContext& context) {
  return document_text(result_of(regions, recipe, problem, result, context));
}

}  // namespace cell
