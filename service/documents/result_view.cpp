#include "service/documents/result_view.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "calib_core/identification/face_distances.hpp"
#include "calib_core/identification/validate.hpp"
#include "service/base/json_figures.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/internal/decision_rule_view.hpp"
#include "service/documents/internal/geometry_json.hpp"
#include "service/documents/json_view.hpp"
#include "service/documents/parameter_view.hpp"
#include "service/documents/validation_view.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

Json micrometres(std::optional<double> value_m) {
  return value_m ? number(1e3 * mm_from_metres(*value_m)) : Json(nullptr);
}

Json parts_per_million(double relative) { return number(1e6 * relative); }

Json iteration_json(const calib::Iteration& iteration) {
  return {{"condition_number", number(iteration.condition_number)},
          {"scaled_condition_number", number(iteration.scaled_condition_number)},
          {"residual_rms_mm", number_mm(iteration.residual_rms_m)},
          {"step_norm", number(iteration.step_norm)}};
}

Json rejected_json(const std::vector<calib::RejectedTouch>& rejected) {
  Json list = Json::array();
  for (const calib::RejectedTouch& touch : rejected) {
    const bool wrong_plane = touch.reason == calib::RejectionReason::kWrongFace;
    list.push_back({{"touch", touch.touch + 1},
                    {"residual_mm", number_mm(touch.residual_m)},
                    {"reason", wrong_plane ? "wrong_plane" : "outlier"}});
  }
  return list;
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

Json scale_json(const std::optional<calib::ScaleCheck>& scale) {
  if (!scale) {
    return {{"source", nullptr},
            {"std_uncertainty_ppm", nullptr},
            {"stretch_ppm", nullptr},
            {"significance", nullptr},
            {"warning", nullptr}};
  }
  return {{"source", source_name(scale->source)},
          {"std_uncertainty_ppm", parts_per_million(scale->std_relative)},
          {"stretch_ppm", parts_per_million(scale->stretch_relative)},
          {"significance", number(scale->significance)},
          {"warning", scale->warning.empty() ? Json(nullptr) : Json(scale->warning)}};
}

/// Order of cells: x fastest, then y, then z; null where the arm cannot reach.
Json map_json(const Cell& cell, const std::optional<calib::UncertaintyMap>& map) {
  if (!map) return nullptr;
  Json values = Json::array();
  for (const auto& rms_m : map->rms_m) values.push_back(number_mm(rms_m));
  const Eigen::Vector3d& min_m = map->grid.min_m;
  const Eigen::Vector3d extent_m(map->grid.cell_size_m.x() * map->grid.counts[0],
                                 map->grid.cell_size_m.y() * map->grid.counts[1],
                                 map->grid.cell_size_m.z() * map->grid.counts[2]);
  return {{"box",
           {{"name", cell.workspace_box.name},
            {"min_mm", vector_mm_json(min_m)},
            {"max_mm", vector_mm_json(min_m + extent_m)}}},
          {"counts", map->grid.counts},
          {"cell_mm", vector_mm_json(map->grid.cell_size_m)},
          {"values_mm", values}};
}

/// A plane without fitted touches has no p.
Json plane_fits_json(const calib::IdentificationResult& result) {
  Json planes = Json::array();
  for (const calib::FaceDistances& face : result.distances) {
    if (face.role != calib::TouchRole::kFit || !result.lack_of_fit) continue;
    const double p = result.lack_of_fit->p_of_face.at(static_cast<std::size_t>(face.face));
    planes.push_back({{"plane", face.face + 1}, {"p", number(p)}});
  }
  return planes;
}

Json fit_json(const calib::IdentificationProblem& problem, const calib::IdentificationResult& result) {
  const auto& lack_of_fit = result.lack_of_fit;
  const auto& uncertainty = result.uncertainty;
  std::optional<double> degrees;
  if (lack_of_fit) {
    degrees = lack_of_fit->degrees_of_freedom;
  } else if (uncertainty) {
    degrees = uncertainty->degrees_of_freedom;
  }
  return {
      {"noise_declared_um", problem.touch_noise_m > 0.0 ? micrometres(problem.touch_noise_m) : Json(nullptr)},
      {"noise_estimated_um", micrometres(result.noise_estimated_m)},
      {"noise_used_um", uncertainty ? micrometres(uncertainty->noise_m) : Json(nullptr)},
      {"lack_of_fit_p", lack_of_fit ? number(lack_of_fit->p) : Json(nullptr)},
      {"degrees_of_freedom", number(degrees)},
      {"planes", plane_fits_json(result)}};
}

Json rank_json(const calib::IdentificationResult& result) {
  return {{"attainable", result.attainable.count},
          {"off_axis", result.attainable.off_axis_count},
          {"explanation", result.rank_explanation},
          {"smallest_kept", number(result.identifiable.smallest_kept)},
          {"largest_dropped", number(result.identifiable.largest_dropped)}};
}

/// Distances run along the outward normal from the origin: reference + signed distance.
Json plane_json(const Cell& cell, const calib::FaceDistances& face) {
  const double reference = cell.block.faces[static_cast<std::size_t>(face.face)].plane.offset_m;
  const auto percent = [](double part, double whole) {
    return whole == 0.0 ? Json(nullptr) : number(100.0 * (1.0 - std::abs(part) / std::abs(whole)));
  };
  return {{"plane", face.face + 1},
          {"touch_count", face.touch_count},
          {"reference_mm", mm_from_metres(reference)},
          {"nominal_mean_mm", number_mm(reference + face.nominal_mean_m)},
          {"calibrated_mean_mm", number_mm(reference + face.calibrated_mean_m)},
          {"error_removed_percent", percent(face.calibrated_mean_m, face.nominal_mean_m)},
          {"nominal_agreement_percent", percent(face.nominal_mean_m, reference)},
          {"nominal_rms_mm", number_mm(face.nominal_rms_m)},
          {"calibrated_rms_mm", number_mm(face.calibrated_rms_m)}};
}

const char* use_name(const calib::IdentificationResult& result, std::size_t touch) {
  const auto found = std::ranges::find(result.rejected, touch, &calib::RejectedTouch::touch);
  return found == result.rejected.end() ? "used" : "rejected";
}

/// Distances run along the outward normal from the origin, as those of the planes.
Json touches_json(const Cell& cell, const calib::IdentificationProblem& problem,
                  const calib::IdentificationResult& result) {
  Json list = Json::array();
  if (result.status != calib::IdentificationStatus::kConverged) return list;
  const auto distances = calib::touch_distances(problem, result);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const calib::Touch& touch = problem.touches[i];
    const double reference = cell.block.faces[static_cast<std::size_t>(touch.face)].plane.offset_m;
    list.push_back({{"touch", i + 1},
                    {"plane", touch.face + 1},
                    {"role", role_name(touch.role)},
                    {"use", use_name(result, i)},
                    {"nominal_mm", number_mm(reference + distances[i].nominal_m)},
                    {"calibrated_mm", number_mm(reference + distances[i].calibrated_m)}});
  }
  return list;
}

/// Null before the touches are complete: a repetition needs all of them.
Json validation_json(const calib::IdentificationProblem& problem, const calib::IdentificationOptions& options,
                     const calib::IdentificationResult& result, bool complete, const Json& parameters) {
  if (!complete || result.status != calib::IdentificationStatus::kConverged) return nullptr;
  return repetitions_json(parameters, calib::validate(problem, options, result));
}

}  // namespace

Json tip_json(const Cell& cell, const TipPrediction& tip) {
  Json sources = Json::array();
  for (const TipPrediction::OfSource& source : tip.sources) {
    sources.push_back(
        {{"name", source.name}, {"workspace_box_rms_mm", number_mm(source.workspace_box_rms_m)}});
  }
  Json tools = Json::array();
  for (const TipPrediction::OfTool& tool : tip.tools) {
    tools.push_back({{"name", tool.name},
                     {"workspace_box_rms_mm", number_mm(tool.workspace_box_rms_m)},
                     {"joint_ranges_rms_mm", number_mm(tool.joint_ranges_rms_m)}});
  }
  return {{"at_block_rms_mm", number_mm(tip.at_block_rms_m)},
          {"workspace_box_rms_mm", number_mm(tip.workspace_box_rms_m)},
          {"joint_ranges_rms_mm", number_mm(tip.joint_ranges_rms_m)},
          {"sources", sources},
          {"tools", tools},
          {"map", map_json(cell, tip.map)}};
}

Json planes_json(const Cell& cell, const std::vector<calib::FaceDistances>& distances,
                 calib::TouchRole role) {
  Json planes = Json::array();
  for (const calib::FaceDistances& face : distances) {
    if (face.role == role) planes.push_back(plane_json(cell, face));
  }
  return planes;
}

std::string result_document(const TipRegions& regions, const Recipe& recipe,
                            const calib::IdentificationProblem& problem,
                            const calib::IdentificationResult& result, const ResultContext& context) {
  const Cell& cell = regions.cell();
  const calib::IdentificationOptions& options = recipe.identification;
  std::vector<std::string> warnings = result.warnings;
  std::ranges::copy(context.warnings, std::back_inserter(warnings));
  Json document{{"schema", "touchcal/result/1"},
                {"arm", cell.arm.name},
                {"recipe", recipe.name},
                {"touch_count", result.fitted_touch_count},
                {"complete", context.complete},
                {"cell_frames", cell.own_frames},
                {"warnings", warnings},
                {"rejected_touches", rejected_json(result.rejected)},
                {"converged", result.status == calib::IdentificationStatus::kConverged}};
  Json iterations = Json::array();
  for (const calib::Iteration& iteration : result.iterations) iterations.push_back(iteration_json(iteration));
  document["iterations"] = iterations;
  document["identifiable_count"] = result.identifiable.columns.size();
  const calib::Iteration* last = result.iterations.empty() ? nullptr : &result.iterations.back();
  document["condition_number"] = last ? number(last->condition_number) : Json(nullptr);
  document["scaled_condition_number"] = last ? number(last->scaled_condition_number) : Json(nullptr);
  document["singular_values"] = result.singular_values;
  document["rank"] = rank_json(result);
  document["parameters"] = parameters_json(problem, options, result);
  document["correlations"] = correlations_json(result);
  document["artefact_parameters"] = artefact_parameters_json(problem, result);
  document["stiffness"] = stiffness_json(options, result);
  document["planes"] = planes_json(cell, result.distances, calib::TouchRole::kFit);
  document["planes_held_out"] = planes_json(cell, result.distances, calib::TouchRole::kHeldOut);
  document["planes_proof"] = planes_json(cell, result.distances, calib::TouchRole::kProof);
  document["touches"] = touches_json(cell, problem, result);
  document["validation"] =
      validation_json(problem, options, result, context.complete, document["parameters"]);
  document["scale"] = scale_json(result.scale);
  const TipPrediction tip = predict_tip(regions, problem, result);
  document["tip_uncertainty"] = tip_json(cell, tip);
  document["fit"] = fit_json(problem, result);
  const Judgement judgement = judge_by_rule(result, options, cell, tip.workspace_box_rms_m, context.complete);
  document["verdict"] = {{"accepted", judgement.accepted},
                         {"reasons", judgement.reasons},
                         {"decision_rule", decision_rule_json(criteria(result, cell, tip.workspace_box_rms_m),
                                                              cell.acceptance)}};
  document["conditions"] =
      context.conditions.empty() ? conditions_json(cell, {}) : Json::parse(context.conditions);
  return text_of(document);
}

}  // namespace cell
