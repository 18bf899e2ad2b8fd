#pragma once

#include <string>
#include <variant>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/run/tip_prediction.hpp"

namespace cell {

/// identify() on a plan's touches as the nominal arm would make them, exactly on the faces: rank, condition
/// numbers and uncertainties of a run that goes as planned. The errors are all 0.
struct PlannedIdentification {
  calib::IdentificationProblem problem;
  calib::IdentificationResult result;
};
PlannedIdentification identify_planned(const Cell& cell, const Recipe& recipe, const calib::TouchPlan& plan);

/// A plan as it is shown and as it is run.
struct Plan {
  std::string id;  // digest of the document: the same problem gives the same id
  std::string recipe;
  calib::TouchPlan touches;
  std::string document;  // touchcal/plan/1, see plan_view.hpp
};

/// Why there is no plan.
struct PlanRefusal {
  enum class Kind { kPark, kFace, kAccuracy, kWorkspaceBox, kTouches };
  Kind kind = Kind::kFace;
  std::string message;  // one line: what was wanted, the best that can be had, what stands in the way
  std::vector<calib::FaceEffort> efforts;  // what was tried
};

/// Plans a recipe's touches and predicts what they give. Takes seconds; deterministic.
std::variant<Plan, PlanRefusal> make_plan(const TipRegions& regions, const Recipe& recipe,
                                          const calib::PlanningProgress& progress = {});

/// One line for each face: how many postures were tried and what kept most of them from being touches.
std::vector<std::string> effort_lines(const std::vector<calib::FaceEffort>& efforts);

}  // namespace cell
