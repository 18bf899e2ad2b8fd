#pragma once

#include <string>
#include <variant>
#include <vector>

#include "calib_core/identification/identify.hpp"
#include "calib_core/planning/touch_planning.hpp"
#include "config/cell.hpp"
#include "service/run/tip_prediction.hpp"
#include "service/run/verification.hpp"

namespace cell {

/// identify() on the touches of a plan as the nominal arm would make them, exactly on the faces: rank,
/// condition numbers and uncertainties of a run that goes as planned. All errors are 0.
struct PlannedIdentification {
  calib::IdentificationProblem problem;
  calib::IdentificationResult result;
};
PlannedIdentification identify_planned(const Cell& cell, const Recipe& recipe, const calib::TouchPlan& plan);

/// A plan with its document.
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
  std::string message;  // one line: what was requested, the best attainable, the obstruction
  std::vector<calib::FaceEffort> efforts;  // what was tried
};

/// Plans the touches of a recipe and predicts their result. Takes seconds; deterministic.
std::variant<Plan, PlanRefusal> make_plan(const TipRegions& regions, const Recipe& recipe,
                                          const calib::PlanningProgress& progress = {});

/// Plans the touches of a run of another kind than a calibration; `regions` and `recipe` as of a run: where
/// the block stands now, and verification_recipe(). Deterministic.
std::variant<Plan, PlanRefusal> make_verification_plan(const TipRegions& regions, const Recipe& recipe,
                                                       const Verification& verification);

/// One line for each face: the postures tried and the most frequent obstructions.
std::vector<std::string> effort_lines(const std::vector<calib::FaceEffort>& efforts);

}  // namespace cell
