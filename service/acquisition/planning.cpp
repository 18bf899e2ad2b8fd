#include "service/acquisition/planning.hpp"

namespace cell {

calib::PlanningProblem planning_problem(const Cell& cell, const Recipe& recipe) {
  calib::PlanningProblem problem{.nominal = cell.arm.model,
                                 .joint_ranges = cell.arm.joint_ranges,
                                 .faces = cell.block.faces,
                                 .stylus = cell.probe.stylus,
                                 .scene = cell.collision_scene(),
                                 .park_joints = cell.park_joints,
                                 .nominal_miss_m = cell.nominal_miss_m,
                                 .tilt_max_rad = cell.stylus_tilt_max_rad};
  for (const int face : recipe.faces) {
    problem.requests.push_back({face, recipe.fit_per_face, recipe.held_out_per_face});
  }
  return problem;
}

}  // namespace cell
