#include "calib_core/planning/aimed_touch.hpp"

#include <span>
#include <utility>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/planning/touch_feasibility.hpp"

namespace calib {
namespace {

/// The planned touch in this pose, computed with the model and the position error of `problem`.
std::variant<AimedTouch, std::string> recompute(PlanningProblem problem, const TouchPose& pose,
                                                const PlannedTouch& planned) {
  const auto joints = solve_near(problem.nominal, pose.block_from_tip, planned.joints);
  if (!joints) return "out of reach";
  auto made = make_touch(problem, find_target(problem, planned.face), pose, *joints);
  if (auto* reason = std::get_if<std::string>(&made)) return std::move(*reason);
  PlannedTouch& touch = std::get<PlannedTouch>(made);
  touch.role = planned.role;
  return AimedTouch{std::move(touch), std::move(problem)};
}

/// Of the tip that touches.
TouchPose pose_of(const PlanningProblem& problem, const PlannedTouch& planned) {
  return {forward_kinematics(problem.nominal, planned.joints) * frame7_from_tip(problem, planned.face),
          planned.tilt_rad};
}

}  // namespace

std::variant<AimedTouch, std::string> nominal_touch(const PlanningProblem& problem,
                                                    const PlannedTouch& planned) {
  return recompute(for_tip_of(problem, planned.face), pose_of(problem, planned), planned);
}

std::variant<AimedTouch, std::string> aim_touch(const PlanningProblem& problem,
                                                const OnlineArmEstimate& estimate,
                                                const PlannedTouch& planned) {
  auto aimed = estimate.aimed_problem(problem, std::span(&planned.joints, 1));
  if (!aimed) return nominal_touch(problem, planned);
  TouchPose pose = pose_of(problem, planned);
  const Eigen::Vector3d point_m = pose.block_from_tip.translation();
  const ContactSurface surface = surface_of(problem.faces[static_cast<std::size_t>(planned.face)]);
  pose.block_from_tip.pretranslate(estimate.face_shift_m(planned.face, point_m) *
                                   normal_at(surface, point_m));
  return recompute(for_tip_of(std::move(*aimed), planned.face), pose, planned);
}

}  // namespace calib
