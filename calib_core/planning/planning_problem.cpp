#include "calib_core/planning/planning_problem.hpp"

#include "calib_core/motion/swept_collision.hpp"

namespace calib {

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
