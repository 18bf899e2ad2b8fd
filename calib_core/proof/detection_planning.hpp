#pragma once

#include <span>
#include <variant>

#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"
#include "calib_core/proof/calibration_record.hpp"
#include "calib_core/proof/proof.hpp"
#include "calib_core/proof/tool_centre.hpp"

/// Touches for a proof or a check: feasible ones as the planner makes them, chosen for what they would show.
namespace calib {

/// Candidates to choose from: more of them change the power by less than what is drawn of them does.
inline constexpr int kDetectionCandidates = 500;

/// The touches of a proof, in a short order, with their transfers. `there`: the planner's problem with the
/// block at the place of the proof, its frame being R_-1, its stand among the obstacles; its requests name
/// the faces that may be touched, candidate_count is how many candidates are tried.
std::variant<TouchPlan, PlanningFailure> plan_proof(const PlanningProblem& there,
                                                    const CalibrationRecord& record, const ProofPlace& place,
                                                    std::span<const ProofAlternative> alternatives);

/// The touches of a check, at the place of the calibration: offsets of joints 2 to 5 are seen beside the
/// arm's growth, and told from each other, from a moved block and from a bent stylus.
std::variant<TouchPlan, PlanningFailure> plan_check(const PlanningProblem& here,
                                                    const CalibrationRecord& record);

/// The touches of find_tool_centre(), at the place of the calibration. `here`: its stylus and its frame 7 are
/// the tip of the tool.
std::variant<TouchPlan, PlanningFailure> plan_tool(const PlanningProblem& here,
                                                   const CalibrationRecord& record, const ToolTip& tip);

}  // namespace calib
