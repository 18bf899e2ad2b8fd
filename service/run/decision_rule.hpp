#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "config/cell.hpp"
#include "service/run/verdict.hpp"

namespace cell {

/// Of a result's expanded uncertainties: 95 % of a normal distribution.
inline constexpr double kCoverageFactor = 2.0;

/// A figure of a result that has an upper limit.
struct Criterion {
  std::string name;             // "held_out_mean"
  std::optional<int> plane;     // from 1
  std::string unit;             // "mm", or "1" for a ratio
  std::optional<double> value;  // in that unit; nothing when there is no honest figure
  double limit = 0.0;
  /// k = 2. Nothing for a figure that is exact or is itself an uncertainty.
  std::optional<double> expanded_uncertainty;

  /// The value itself is within the limit: simple acceptance.
  [[nodiscard]] bool within_limit() const;
  /// ISO 14253-1: conformance is proved, the value and its expanded uncertainty are within the limit.
  [[nodiscard]] bool proved() const;
};

/// The limits of the cell that a figure of this result is held against. The uncertainty of a mean of n
/// held-out touches has the noise of a touch over root n and the face's own standard deviation in it, that
/// of their rms the noise over root 2n.
std::vector<Criterion> criteria(const calib::IdentificationResult& result, const Cell& cell,
                                std::optional<double> tip_box_rms_m);

/// judge() of verdict.hpp with the cell's limits and by the rule that its file names: where it wants
/// conformance proved, a value within its limit is not enough.
Judgement judge_by_rule(const calib::IdentificationResult& result,
                        const calib::IdentificationOptions& options, const Cell& cell,
                        std::optional<double> tip_box_rms_m, bool complete);

}  // namespace cell
