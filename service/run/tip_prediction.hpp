#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/cell.hpp"

namespace cell {

/// An error without a tolerance matters in a region if one unit of it (a metre or a radian), with its effect
/// on the identified errors, moves the tip there by more than this, root mean square.
inline constexpr double kUnknownMattersMetres = 1e-3;

/// Indices of the touches that a result was fitted to: rejected ones are not among them.
std::vector<std::size_t> fitted_touches(const calib::IdentificationProblem& problem,
                                        const calib::IdentificationResult& result);

/// The errors without a tolerance that matter in a region: indices into ArmVector.
std::vector<int> unknown_errors_in(const calib::TipRegion& region,
                                   const calib::UncertaintyBudget& uncertainty);

/// The predicted deviation over a region, metres. Absent if an error of unknown size matters there or the
/// region holds no posture: any figure would mislead.
std::optional<double> predicted_rms_m(const calib::TipRegion& region,
                                      const calib::UncertaintyBudget& uncertainty);

/// The regions in which a cell predicts the error of its tip: postures of the nominal arm. Each region is
/// computed on first use (milliseconds; the map about a tenth of a second) and kept. Any thread may ask.
class TipRegions {
  struct Made;

 public:
  /// What was computed, for other regions of the same cell: whoever needs a part first computes it for all.
  using Shared = std::shared_ptr<Made>;

  /// For the stylus tip or a named tool centre point.
  struct Regions {
    calib::TipRegion workspace_box;
    calib::TipRegion joint_ranges;
  };

  /// `cell` must outlive the regions.
  explicit TipRegions(const Cell& cell);
  /// `made`: of a cell with the same arm, tools, workspace box and place of the block.
  TipRegions(const Cell& cell, Shared made) : cell_(cell), made_(std::move(made)) {}

  [[nodiscard]] const Cell& cell() const { return cell_; }
  [[nodiscard]] const Shared& shared() const { return made_; }
  [[nodiscard]] const Regions& tip() const;
  /// The postures of tip().workspace_box.
  [[nodiscard]] const calib::TipPostures& box_postures() const;
  [[nodiscard]] const std::map<std::string, Regions>& tools() const;
  /// The workspace box, divided into cells of about 100 mm.
  [[nodiscard]] const calib::TipMap& map() const;

 private:
  struct Tip {
    calib::TipPostures box_postures;
    Regions regions;
  };
  struct Made {
    std::once_flag tip_once, tools_once, map_once;
    Tip tip;
    std::map<std::string, Regions> tools;
    calib::TipMap map;
  };

  [[nodiscard]] const Tip& made_tip() const;

  const Cell& cell_;
  Shared made_;
};

/// Predicted tip errors of the calibrated arm; absent where a figure would mislead.
struct TipPrediction {
  struct OfSource {
    std::string name;
    std::optional<double> workspace_box_rms_m;  // from this source alone
  };
  struct OfTool {
    std::string name;
    std::optional<double> workspace_box_rms_m;
    std::optional<double> joint_ranges_rms_m;
  };

  /// calib::kTipCoverageFactor times the predicted error over the postures of the workspace box.
  struct Expanded {
    std::optional<double> box_rms_m;
    std::optional<double> box_p95_m;  // not exceeded in 95 % of the postures
    std::optional<double> box_max_m;
  };
  struct InArmFrame {
    std::optional<double> at_block_rms_m;
    std::optional<double> workspace_box_rms_m;
    std::optional<double> joint_ranges_rms_m;
    Expanded expanded;
  };

  /// The result is of the arm as warm as it was at the touches: the same with an arm that is warmer by this.
  struct Warmer {
    double rise_k = 0.0;
    std::optional<double> workspace_box_rms_m;
    std::optional<double> joint_ranges_rms_m;
  };

  std::optional<double> at_block_rms_m;  // over the postures of the fitted touches
  std::optional<double> workspace_box_rms_m;
  std::optional<double> joint_ranges_rms_m;
  Expanded expanded;
  std::vector<int> unknown_errors;  // unknown_errors_in() the workspace box
  std::optional<Warmer> warmer;     // nothing where the arm's file has no figures for its warming
  InArmFrame arm_frame;             // the same with the block's place nominal: calib::in_arm_frame()
  std::vector<OfSource> sources;
  std::vector<OfTool> tools;
  std::optional<calib::UncertaintyMap> map;
};

/// All absent before the identification has converged.
TipPrediction predict_tip(const TipRegions& regions, const calib::IdentificationProblem& problem,
                          const calib::IdentificationResult& result);

}  // namespace cell
