#pragma once

#include <span>
#include <variant>

#include "calib_core/estimation/artefact.hpp"
#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/planning/touch_plan.hpp"

namespace calib {

/// Postures to choose from: the stylus leans far in enough of them.
inline constexpr int kQualifyingCandidates = 400;
/// The stylus leans at least this far from the face's normal: a run-out shows by the sine of it.
inline constexpr double kQualifyingLeanMinRadians = 0.5;

/// Joints 1 to 5 move by at most so much between the turns: what an arm is wrong by, some milliradians, then
/// changes by micrometres. The ball has to be within millimetres of the axis of joint 6.
inline constexpr double kTurningArmMoveMaxRadians = 0.005;

/// The touches of qualify(), each as feasible as any: eight turns of the stylus at one place of a flat face,
/// the first of them ten times and between the others, so that each is made anew; then the two faces of each
/// known length in postures as alike as there are, so that what the arm is wrong by is nearly alike. A length
/// that cannot be touched is left out. `here`: its requests name the faces that may be touched,
/// candidate_count is how many candidates are tried. A failure says that the park posture is not clear, that
/// no face is flat, that turning would move the whole arm, or how many turns there were at best and where.
std::variant<TouchPlan, PlanningFailure> plan_qualification(const PlanningProblem& here,
                                                            std::span<const KnownLength> lengths);

}  // namespace calib
