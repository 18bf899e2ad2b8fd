#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "config/cell.hpp"

namespace cell {

/// An error that nobody has a tolerance for matters in a region when one unit of it (a metre or a radian),
/// with what it does to the identified errors, moves the tip there by more than this, root mean square.
inline constexpr double kUnknownMattersMetres = 1e-3;

/// The touches that a result was fitted to, indices into the problem's: those rejected are not among them.
std::vector<std::size_t> fitted_touches(const calib::IdentificationProblem& problem,
                                        const calib::IdentificationResult& result);

/// The predicted deviation over a region, metres. Nothing when an error of unknown size matters there, or
/// when the region holds no posture: no figure is honest then.
std::optional<double> predicted_rms_m(const calib::TipRegion& region,
                                      const calib::UncertaintyBudget& uncertainty);

/// Where a cell wants to know how far off its tip is predicted to be: postures of the nominal arm. Each
/// region is made at its first need (milliseconds; the map about a tenth of a second) and kept. One thread.
class TipRegions {
 public:
  /// Of the stylus tip or a named tool centre.
  struct Regions {
    calib::TipRegion workspace_box;
    calib::TipRegion joint_ranges;
  };

  /// `cell` must outlive the regions.
  explicit TipRegions(const Cell& cell) : cell_(cell) {}

  [[nodiscard]] const Cell& cell() const { return cell_; }
  [[nodiscard]] const Regions& tip() const;
  [[nodiscard]] const std::map<std::string, Regions>& tools() const;
  /// The workspace box in cells of about 100 mm.
  [[nodiscard]] const calib::TipMap& map() const;

 private:
  const Cell& cell_;
  mutable std::optional<Regions> tip_;
  mutable std::optional<std::map<std::string, Regions>> tools_;
  mutable std::optional<calib::TipMap> map_;
};

/// How far off the calibrated arm is predicted to be; nothing where there is no honest figure.
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

  std::optional<double> at_block_rms_m;  // over the postures of the fitted touches
  std::optional<double> workspace_box_rms_m;
  std::optional<double> joint_ranges_rms_m;
  std::vector<OfSource> sources;
  std::vector<OfTool> tools;
  std::optional<calib::UncertaintyMap> map;
};

/// Nothing of it is known before the identification has converged.
TipPrediction predict_tip(const TipRegions& regions, const calib::IdentificationProblem& problem,
                          const calib::IdentificationResult& result);

}  // namespace cell
