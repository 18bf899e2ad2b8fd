#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// Coverage factor of expanded uncertainties: 95 % of a normal distribution.
inline constexpr double kCoverageFactor = 2.0;

/// If a larger share of the touches is rejected, the others are not trusted either.
inline constexpr double kRejectedShareMax = 0.1;

/// A figure of a result with its limit.
struct Criterion {
  std::string name;                 // "held_out_mean"
  std::optional<int> plane = {};    // from 1
  std::optional<std::string> tool;  // of the cell's file; nothing for the stylus
  std::string unit;                 // "mm", or "1" for a ratio, a count or a yes (1) or no (0)
  std::optional<double> value;      // in that unit; absent if it cannot be computed
  double limit = 0.0;
  bool at_least = false;  // the value must not be under the limit; else not over it
  /// k = 2, in the direction of the limit. Absent for a figure that is exact or is itself an uncertainty.
  std::optional<double> expanded_uncertainty = {};
  bool is_measured = false;  // a guarded rule wants it proved
  std::string miss;          // what is said of a result that is not within the limit

  /// The value itself is within the limit: simple acceptance.
  [[nodiscard]] bool within_limit() const;
  /// ISO 14253-1: conformance is proved, the value and its expanded uncertainty are within the limit. Nothing
  /// for a figure without an uncertainty: there is nothing to prove.
  [[nodiscard]] std::optional<bool> proved() const;
};

/// What is judged of the predicted tip; absent where it is unknown.
struct JudgedTip {
  struct OfTool {
    std::string name;
    std::optional<double> box_rms_m;
  };
  std::optional<double> box_rms_m;  // one standard deviation over the workspace box
  std::optional<double> box_max_m;  // expanded, k = 2, at the worst posture in it
  /// Errors that no touch shows, that move the tip in the box and whose size nobody says: indices into
  /// ArmVector.
  std::vector<int> unknown_errors = {};
  std::vector<OfTool> tools = {};
};

JudgedTip judged_tip(const TipPrediction& tip);

/// True if the result holds an error for this candidate: with a prior every one that is not excluded, else
/// the identified ones.
bool is_estimated(const calib::IdentificationOptions& options, const calib::IdentifiableSet& identifiable,
                  int index);

/// Everything that can reject a result of this recipe: each is a reason of a verdict. A guarded
/// rule adds what is within its limit and not proved.
/// `complete`: every touch of the recipe was made. The uncertainty of the mean of held-out
/// touches is that of FaceDistances::calibrated_mean_std_m, that of their rms reaches the upper confidence
/// bound of a chi-square variable.
std::vector<Criterion> criteria(const calib::IdentificationResult& result, const Recipe& recipe,
                                const Cell& cell, const JudgedTip& tip, bool complete);

}  // namespace cell
