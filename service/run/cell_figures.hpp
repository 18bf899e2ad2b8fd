#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace cell {

/// What is stored of the cell's checks and models, and known of its certificates, as figures for who watches
/// many cells. The calibration is the one that a check would be of. Nothing, or no row, is unknown.
struct CellFigures {
  using Time = std::chrono::system_clock::time_point;

  /// End of the newest check of the calibration, of those that have a verdict or are of its reference.
  std::optional<Time> checked_at;
  std::optional<bool> is_unchanged;         // by the newest check with a verdict
  std::optional<Time> check_due_at;         // nothing where the cell's file has no rule
  std::map<int, double> joint_offsets_rad;  // by joint from 1; these two of the newest check with a verdict
  std::optional<double> arm_growth;         // of the arm's lengths since the reference: 1e-6 is a ppm
  /// How much of its limit the newest point of a chart has used up, by the chart's quantity ("joint_3"):
  /// over 1 is beyond it. The larger of the point and its weighted mean, each by its own limit.
  std::map<std::string, double> limit_ratios;
  std::optional<bool> is_proved;  // by the newest proof of the calibration that has a verdict
  std::optional<Time> model_approved_at;
  std::optional<bool> is_model_of_this_arm;      // nothing where a serial number is unknown
  std::map<std::string, Time> certificate_ends;  // by artefact: "block", "probe"
};

}  // namespace cell
