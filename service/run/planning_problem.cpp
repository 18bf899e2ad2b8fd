#include "service/run/planning_problem.hpp"

#include <algorithm>
#include <utility>

#include "config/identification_problem.hpp"
#include "config/place_cell.hpp"
#include "config/probe_tips_file.hpp"
#include "config/touched_places.hpp"

namespace cell {

namespace {

/// A face whose number of touches is free has at least a third of an even share and at most twice of it:
/// fewer would not show a block that was moved, more would leave no other face to go to in between.
constexpr int kLeastShare = 3;
constexpr int kMostShare = 2;
/// A face that is found in place costs three touches before any tells of the arm; twice as many show from all
/// sides where it is.
constexpr int kEstimatedFaceTouches = 6;

/// The fewest and the most touches of a face whose number is free. A place that the touches find is found on
/// each of its faces; of a further tip each face has one, and more of those that show most.
std::pair<int, int> bounds_of(const Cell& cell, const Recipe& recipe, int face, int face_count) {
  const auto of_block = static_cast<std::size_t>(face) % cell.block.faces.size();
  const bool is_estimated = cell.block.face_uncertainties[of_block].estimated ||
                            is_found_by_touches(cell.block, recipe, place_of_face(cell.block, recipe, face));
  const int even_share = is_estimated ? kEstimatedFaceTouches : 1;
  const int least = tip_of_face(cell.block, recipe, face) > 0
                        ? 1
                        : std::max(even_share, recipe.goal.fit_count / (kLeastShare * face_count));
  return {least, std::max(least, kMostShare * recipe.goal.fit_count / face_count)};
}

/// Its ball and its stem.
std::vector<std::size_t> bodies_of(const ProbeTip& tip, const std::vector<calib::Capsule>& bodies) {
  std::vector<std::size_t> own;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (is_ball_of(tip, bodies[i]) || is_stem_of(tip, bodies[i])) own.push_back(i);
  return own;
}

/// A tip's frame: z along its stem, out of the tip.
std::vector<calib::PlanningTip> planning_tips(const Cell& cell, const Recipe& recipe,
                                              const std::vector<calib::Capsule>& bodies) {
  std::vector<calib::PlanningTip> tips;
  for (const int index : recipe.tips) {
    const ProbeTip& tip = cell.probe.tips.at(static_cast<std::size_t>(index));
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), tip.direction);
    tips.push_back({.frame7_from_tip = Eigen::Translation3d(tip.center_m) * turn,
                    .radius_m = tip.radius_m,
                    .within_m = tip.within_m,
                    .bodies = bodies_of(tip, bodies)});
  }
  return tips;
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

calib::PlanningProblem planning_problem(const Cell& cell, const Recipe& recipe, int place) {
  const Cell there = cell_at_place(cell, recipe, place);
  const calib::CollisionScene scene = there.collision_scene();
  calib::PlanningProblem problem{
      .nominal = there.arm.model,
      .joint_ranges = cell.arm.joint_ranges,
      .faces = faces_of_places(cell.block, recipe),
      .stylus = cell.probe.stylus,
      .tips = planning_tips(cell, recipe, scene.bodies),
      .scene = scene,
      .park_joints = cell.park_joints,
      .nominal_position_error_m = cell.face_error_m() + found_within_m(cell.block, recipe, place),
      .tilt_max_rad = cell.stylus_tilt_max_rad,
      .candidate_count = recipe.candidate_count,
      .knowledge = identification_problem(there, recipe, place),
      .identification = recipe.identification,
      .workspace_box = there.workspace_box,
      .motion = motion_limits(cell)};
  problem.goal = recipe.goal;
  const auto face_count = static_cast<int>(touched_faces(cell.block, recipe).size());
  const bool each = recipe.fit_per_face > 0;
  if (each) problem.goal.fit_count = recipe.fit_per_face * face_count;
  for (const int face : faces_at_place(cell.block, recipe, place)) {
    const auto [least, most] = each ? std::pair(recipe.fit_per_face, recipe.fit_per_face)
                                    : bounds_of(cell, recipe, face, face_count / tip_count(recipe));
    const bool is_of_first_tip = tip_of_face(cell.block, recipe, face) == 0;
    problem.requests.push_back({.face = face,
                                .fit_min = least,
                                .fit_max = most,
                                .held_out_count = is_of_first_tip ? recipe.held_out_per_face : 0});
  }
  return problem;
}

std::vector<calib::PlanningProblem> planning_problems(const Cell& cell, const Recipe& recipe) {
  std::vector<calib::PlanningProblem> problems;
  for (int place = 0; place < place_count(recipe); ++place)
    problems.push_back(planning_problem(cell, recipe, place));
  return problems;
}

}  // namespace cell
