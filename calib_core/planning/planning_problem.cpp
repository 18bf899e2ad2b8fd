#include "calib_core/planning/planning_problem.hpp"

#include <algorithm>

#include "calib_core/kinematics/tool_frame.hpp"
#include "calib_core/motion/swept_collision.hpp"

namespace calib {
namespace {

/// The further tip that touches a face; null for the first one.
const PlanningTip* tip_of(const PlanningProblem& problem, int face) {
  const std::size_t tip = problem.knowledge.artefact.tip_of(static_cast<std::size_t>(face));
  return tip == 0 || problem.tips.empty() ? nullptr : &problem.tips.at(tip - 1);
}

/// What is fixed in R_6 and R_7 stays where it is when these frames are others.
void keep_in_place(int frame, const Eigen::Isometry3d& new_from_old, PlanningProblem& problem) {
  PointMass& mass = problem.nominal.masses[static_cast<std::size_t>(frame)];
  mass.center_in_frame_m = new_from_old * mass.center_in_frame_m;
  for (Capsule& body : problem.scene.bodies) {
    if (body.frame != frame) continue;
    body.from_m = new_from_old * body.from_m;
    body.to_m = new_from_old * body.to_m;
  }
}

/// Against the ball of this tip all of the probe is where it is as well as the ball is; its own stem and ball
/// go with it.
void loosen(const PlanningTip& tip, PlanningProblem& problem) {
  for (std::size_t i = 0; i < problem.scene.bodies.size(); ++i) {
    Capsule& body = problem.scene.bodies[i];
    if (body.frame != kFrameCount - 1) continue;
    const bool is_own = std::ranges::find(tip.bodies, i) != tip.bodies.end();
    body.loose_m = is_own ? 0.0 : body.loose_m + tip.within_m;
  }
}

}  // namespace

Eigen::Isometry3d frame7_from_tip(const PlanningProblem& problem, int face) {
  const PlanningTip* tip = tip_of(problem, face);
  return tip ? tip->frame7_from_tip : Eigen::Isometry3d::Identity();
}

double ball_position_error_m(const PlanningProblem& problem, int face) {
  const PlanningTip* tip = tip_of(problem, face);
  if (!tip) return problem.nominal_position_error_m;
  return problem.nominal_position_error_m + tip->within_m +
         kOrientationErrorMaxRadians * tip->frame7_from_tip.translation().norm();
}

PlanningProblem for_tip_of(PlanningProblem problem, int face) {
  const PlanningTip* found = tip_of(problem, face);
  if (!found) return problem;
  const PlanningTip tip = *found;
  problem.nominal_position_error_m = ball_position_error_m(problem, face);
  problem.tips.clear();
  problem.stylus.radius_m = tip.radius_m;
  loosen(tip, problem);
  const double before_rad = problem.nominal.links[kJointCount].theta_rad;
  mount_tool(problem.nominal, frame_transform(problem.nominal.links.back()) * tip.frame7_from_tip);
  const double turned_rad = problem.nominal.links[kJointCount].theta_rad - before_rad;
  keep_in_place(kFrameCount - 2, Eigen::Isometry3d(Eigen::AngleAxisd(-turned_rad, Eigen::Vector3d::UnitZ())),
                problem);
  keep_in_place(kFrameCount - 1, tip.frame7_from_tip.inverse(), problem);
  return problem;
}

ContactSurface touched_surface(const PlanningProblem& problem, int face) {
  ContactSurface surface = contact_plane(problem.faces[static_cast<std::size_t>(face)], problem.stylus);
  if (const PlanningTip* tip = tip_of(problem, face)) {
    surface.offset_m += tip->radius_m - problem.stylus.radius_m;
    surface.ball_m = tip->frame7_from_tip.translation();
  }
  return surface;
}

CollisionScene travel_scene(const PlanningProblem& problem) {
  CollisionScene scene = problem.scene;
  const Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  scene.bodies.push_back({"tip", kFrameCount - 1, tip, tip, problem.stylus.radius_m});
  for (Capsule& body : scene.bodies) {
    if (body.frame == kFrameCount - 1) body.margin_m += kSlowZoneMetres + kSweptErrorMaxMetres;
  }
  return scene;
}

}  // namespace calib
