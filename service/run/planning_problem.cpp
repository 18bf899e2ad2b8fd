#include "service/run/planning_problem.hpp"

#include <algorithm>
#include <utility>

#include "config/identification_problem.hpp"

namespace cell {

namespace {

/// A face whose number of touches is free has at least a third of an even share and at most twice of it:
/// fewer would not show a block that was moved, more would leave no other face to go to in between.
constexpr int kLeastShare = 3;
constexpr int kMostShare = 2;
/// A face that is found in place costs three touches before any tells of the arm; twice as many show from all
/// sides where it is.
constexpr int kEstimatedFaceTouches = 6;

/// The fewest and the most touches of a face whose number is free.
std::pair<int, int> bounds_of(const Cell& cell, const Recipe& recipe, int face) {
  const int faces = static_cast<int>(recipe.faces.size());
  const bool is_estimated = cell.block.face_uncertainties[static_cast<std::size_t>(face)].estimated;
  const int least =
      std::max(is_estimated ? kEstimatedFaceTouches : 1, recipe.goal.fit_count / (kLeastShare * faces));
  return {least, std::max(least, kMostShare * recipe.goal.fit_count / faces)};
}

calib::MotionLimits motion_limits(const Cell& cell) {
  calib::MotionLimits limits{.joint_speeds_max = cell.arm.joint_speeds_max,
                             .travel_m_s = cell.speeds.travel_m_s,
                             .approach_m_s = cell.speeds.approach_m_s,
                             .search_m_s = cell.speeds.search_m_s};
  if (const auto& second = cell.speeds.second) {
    limits.second_m_s = second->speed_m_s;
    limits.second_backoff_m = second->backoff_m;
  }
  return limits;
}

}  // namespace

calib::PlanningProblem planning_problem(const Cell& cell, const Recipe& recipe) {
  calib::PlanningProblem problem{.nominal = cell.arm.model,
                                 .joint_ranges = cell.arm.joint_ranges,
                                 .faces = cell.block.faces,
                                 .stylus = cell.probe.stylus,
                                 .scene = cell.collision_scene(),
                                 .park_joints = cell.park_joints,
                                 .nominal_position_error_m = cell.face_error_m(),
                                 .tilt_max_rad = cell.stylus_tilt_max_rad,
                                 .candidate_count = recipe.candidate_count,
                                 .knowledge = identification_problem(cell, recipe),
                                 .identification = recipe.identification,
                                 .workspace_box = cell.workspace_box,
                                 .motion = motion_limits(cell)};
  problem.goal = recipe.goal;
  const int faces = static_cast<int>(recipe.faces.size());
  const bool each = recipe.fit_per_face > 0;
  if (each) problem.goal.fit_count = recipe.fit_per_face * faces;
  for (const int face : recipe.faces) {
    const auto [least, most] =
        each ? std::pair(recipe.fit_per_face, recipe.fit_per_face) : bounds_of(cell, recipe, face);
    problem.requests.push_back(
        {.face = face, .fit_min = least, .fit_max = most, .held_out_count = recipe.held_out_per_face});
  }
  return problem;
}

}  // namespace cell
