#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/run/verdict.hpp"

namespace cell {

/// Coverage factor of expanded uncertainties: 95 % of a normal distribution.
inline constexpr double kCoverageFactor = 2.0;

/// A figure of a result with its upper limit.
struct Criterion {
  std::string name;             // "held_out_mean"
  std::optional<int> plane;     // from 1
  std::string unit;             // "mm", or "1" for a ratio
  std::optional<double> value;  // in that unit; absent if it cannot be computed
  double limit = 0.0;
  /// k = 2. Absent for a figure that is exact or is itself an uncertainty.
  std::optional<double> expanded_uncertainty;

  /// The value itself is within the limit: simple acceptance.
  [[nodiscard]] bool within_limit() const;
  /// ISO 14253-1: conformance is proved, the value and its expanded uncertainty are within the limit.
  [[nodiscard]] bool proved() const;
};

/// Every figure of the result that the cell limits. The uncertainty of the mean of n held-out touches
/// combines the noise of one touch over root n with the standard deviation of the face; that of their rms is
/// the noise over root 2n.
std::vector<Criterion> criteria(const calib::IdentificationResult& result, const Cell& cell,
                                std::optional<double> tip_box_rms_m);

/// judge() of verdict.hpp with the cell's limits and the decision rule of its file: a guarded rule accepts
/// only proved conformance.
Judgement judge_by_rule(const calib::IdentificationResult& result,
                        const calib::IdentificationOptions& options, const Cell& cell,
                        std::optional<double> tip_box_rms_m, bool complete);

}  // namespace cell
