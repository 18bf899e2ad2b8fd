#pragma once

#include "service/documents/plan.hpp"
#include "service/documents/plan_document.hpp"
#include "service/store/run_kind.hpp"

namespace cell {

/// touchcal/plan/1 with plan_id null: the predicted figures, what limits them, and every step of every touch.
/// In `joints_deg` the ball of the nominal arm touches the nominal face.
PlanDocument plan_of(const TipRegions& regions, const Recipe& recipe, const calib::TouchPlan& plan,
                     const PlannedIdentification& planned);

/// The same of a proof or a check: nothing is identified, so that there are no predicted figures.
PlanDocument plan_of_verification(const Cell& cell, const Recipe& recipe, const calib::TouchPlan& plan,
                                  RunKind kind);

/// Sources with a smaller share appear in the figures only, not in words.
inline constexpr double kShareReportedMin = 0.05;

/// The sources of the predicted tip error in the workspace box, largest first, with their share of its
/// square.
struct ErrorShare {
  std::string source;
  double rms_m = 0.0;  // from this source alone
  double share = 0.0;  // 0 to 1
};
std::vector<ErrorShare> error_shares(const TipPrediction& tip);

}  // namespace cell
