#include "service/run/tip_prediction.hpp"

#include <algorithm>

namespace cell {
namespace {

constexpr int kMapPostureCount = 4000;
constexpr double kMapCellMetres = 0.1;
constexpr double kMapCellsMax = 2000.0;  // a larger box gets coarser cells

TipRegions::Regions regions_of(const Cell& cell, const calib::ToolCentre& tool) {
  const calib::JointRanges& ranges = cell.arm.joint_ranges;
  return {.workspace_box = calib::region_over_box(cell.arm.model, ranges, cell.workspace_box, tool),
          .joint_ranges = calib::region_over_joint_ranges(cell.arm.model, ranges, tool)};
}

TipPrediction::Expanded expanded_over(const calib::TipPostures& postures, const calib::TipRegion& region,
                                      const calib::UncertaintyBudget& uncertainty) {
  if (!predicted_rms_m(region, uncertainty)) return {};
  const auto spread = postures.spread(uncertainty.covariance());
  if (!spread) return {};
  return {.box_rms_m = calib::kTipCoverageFactor * spread->rms_m,
          .box_p95_m = calib::kTipCoverageFactor * spread->p95_m,
          .box_max_m = calib::kTipCoverageFactor * spread->max_m};
}

calib::TipRegion over_fitted_touches(const calib::IdentificationProblem& problem,
                                     const calib::IdentificationResult& result) {
  std::vector<calib::JointVector> postures;
  for (const std::size_t i : fitted_touches(problem, result)) postures.push_back(problem.touches[i].joints);
  return calib::region_over_postures(problem.nominal, postures);
}

/// predicted_rms_m() with the covariance of `uncertainty`, which is a sum of large matrices.
std::optional<double> rms_where_known_m(const calib::TipRegion& region,
                                        const calib::UncertaintyBudget& uncertainty,
                                        const calib::ArmMatrix& covariance) {
  if (!unknown_errors_in(region, uncertainty).empty()) return std::nullopt;
  return region.rms_m(covariance);
}

calib::UncertaintyMap predicted_map(const calib::TipMap& map, const calib::UncertaintyBudget& uncertainty) {
  const calib::ArmMatrix covariance = uncertainty.covariance();
  calib::UncertaintyMap predicted{.grid = map.grid, .rms_m = {}};
  for (const calib::TipRegion& region : map.cells)
    predicted.rms_m.push_back(rms_where_known_m(region, uncertainty, covariance));
  return predicted;
}

TipPrediction::Warmer warmer_by(const Growth& growth, const calib::KinematicModel& model,
                                const TipRegions::Regions& tip, const calib::UncertaintyBudget& uncertainty) {
  const calib::ArmVector grown = errors_by_growth(model, growth.expansion_per_k * growth.rise_k);
  const calib::ArmMatrix square = grown * grown.transpose();
  const auto with_growth = [&](const calib::TipRegion& region) -> std::optional<double> {
    const auto cold_m = predicted_rms_m(region, uncertainty);
    const auto by_growth_m = region.rms_m(square);
    if (!cold_m || !by_growth_m) return std::nullopt;
    return std::hypot(*cold_m, *by_growth_m);
  };
  return {.rise_k = growth.rise_k,
          .workspace_box_rms_m = with_growth(tip.workspace_box),
          .joint_ranges_rms_m = with_growth(tip.joint_ranges)};
}

}  // namespace

std::vector<std::size_t> fitted_touches(const calib::IdentificationProblem& problem,
                                        const calib::IdentificationResult& result) {
  std::vector<std::size_t> fitted;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const bool rejected =
        std::ranges::find(result.rejected, i, &calib::RejectedTouch::touch) != result.rejected.end();
    if (problem.touches[i].role == calib::TouchRole::kFit && !rejected) fitted.push_back(i);
  }
  return fitted;
}

std::vector<int> unknown_errors_in(const calib::TipRegion& region,
                                   const calib::UncertaintyBudget& uncertainty) {
  std::vector<int> matter;
  for (std::size_t i = 0; i < uncertainty.unseen_without_tolerance.size(); ++i) {
    const auto direction = uncertainty.unknown_directions.col(static_cast<Eigen::Index>(i));
    // Squares: those of no motion at all may come out a little under 0.
    const double square = direction.dot(region.mean_square * direction);
    if (!(square <= kUnknownMattersMetres * kUnknownMattersMetres))
      matter.push_back(uncertainty.unseen_without_tolerance[i]);
  }
  return matter;
}

std::optional<double> predicted_rms_m(const calib::TipRegion& region,
                                      const calib::UncertaintyBudget& uncertainty) {
  return rms_where_known_m(region, uncertainty, uncertainty.covariance());
}

TipRegions::TipRegions(const Cell& cell) : TipRegions(cell, std::make_shared<Made>()) {}

const TipRegions::Tip& TipRegions::made_tip() const {
  std::call_once(made_->tip_once, [this] {
    auto box_postures = calib::derive_at_postures(
        cell_.arm.model,
        calib::postures_in_box(cell_.arm.model, cell_.arm.joint_ranges, cell_.workspace_box));
    Regions regions{.workspace_box = box_postures.region(),
                    .joint_ranges = calib::region_over_joint_ranges(cell_.arm.model, cell_.arm.joint_ranges)};
    made_->tip = {.box_postures = std::move(box_postures), .regions = std::move(regions)};
  });
  return made_->tip;
}

const TipRegions::Regions& TipRegions::tip() const { return made_tip().regions; }

const calib::TipPostures& TipRegions::box_postures() const { return made_tip().box_postures; }

const std::map<std::string, TipRegions::Regions>& TipRegions::tools() const {
  std::call_once(made_->tools_once, [this] {
    for (const auto& [name, tool] : cell_.tools) made_->tools.emplace(name, regions_of(cell_, tool));
  });
  return made_->tools;
}

const calib::TipMap& TipRegions::map() const {
  std::call_once(made_->map_once, [this] {
    const double volume_m3 = (cell_.workspace_box.max_m - cell_.workspace_box.min_m).prod();
    const double edge_m = std::max(kMapCellMetres, std::cbrt(volume_m3 / kMapCellsMax));
    const auto postures = calib::postures_in_box(cell_.arm.model, cell_.arm.joint_ranges, cell_.workspace_box,
                                                 std::nullopt, kMapPostureCount);
    made_->map =
        calib::make_tip_map(cell_.arm.model, postures, calib::divide_box(cell_.workspace_box, edge_m));
  });
  return made_->map;
}

TipPrediction predict_tip(const TipRegions& regions, const calib::IdentificationProblem& problem,
                          const calib::IdentificationResult& result) {
  TipPrediction prediction;
  if (!result.uncertainty) return prediction;
  const calib::UncertaintyBudget& uncertainty = *result.uncertainty;
  const TipRegions::Regions& tip = regions.tip();
  const calib::TipRegion at_block = over_fitted_touches(problem, result);
  prediction.at_block_rms_m = predicted_rms_m(at_block, uncertainty);
  prediction.workspace_box_rms_m = predicted_rms_m(tip.workspace_box, uncertainty);
  prediction.joint_ranges_rms_m = predicted_rms_m(tip.joint_ranges, uncertainty);
  prediction.expanded = expanded_over(regions.box_postures(), tip.workspace_box, uncertainty);
  prediction.unknown_errors = unknown_errors_in(tip.workspace_box, uncertainty);
  if (const auto& growth = regions.cell().arm.growth)
    prediction.warmer = warmer_by(*growth, problem.nominal, tip, uncertainty);
  const calib::UncertaintyBudget of_arm = calib::in_arm_frame(uncertainty);
  prediction.arm_frame = {.at_block_rms_m = predicted_rms_m(at_block, of_arm),
                          .workspace_box_rms_m = predicted_rms_m(tip.workspace_box, of_arm),
                          .joint_ranges_rms_m = predicted_rms_m(tip.joint_ranges, of_arm),
                          .expanded = expanded_over(regions.box_postures(), tip.workspace_box, of_arm)};
  for (const calib::UncertaintySource& source : uncertainty.sources)
    prediction.sources.push_back({source.name, tip.workspace_box.rms_m(source.covariance)});
  for (const auto& [name, tool] : regions.tools()) {
    prediction.tools.push_back({name, predicted_rms_m(tool.workspace_box, uncertainty),
                                predicted_rms_m(tool.joint_ranges, uncertainty)});
  }
  prediction.map = predicted_map(regions.map(), uncertainty);
  return prediction;
}

}  // namespace cell
