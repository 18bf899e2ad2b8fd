#include "calib_core/planning/transfer_planning.hpp"

#include "calib_core/motion/path_shortcut.hpp"
#include "calib_core/motion/transfer_path.hpp"

namespace calib {

std::optional<std::vector<JointVector>> find_transfer(const PlanningProblem& problem, const JointVector& from,
                                                      const JointVector& to) {
  const TransferSpace space(problem.nominal, travel_scene(problem), problem.park_joints,
                            problem.nominal_position_error_m);
  auto via = find_path(space, from, to);
  if (!via || via->empty()) return via;
  const PreparedModel model = prepare(problem.nominal);
  const MoveCriteria criteria{
      .is_clear = [&](const JointVector& a, const JointVector& b) { return space.is_clear(a, b); },
      .seconds =
          [&](const JointVector& a, const JointVector& b) {
            return move_time_s(model, problem.motion, a, b, problem.motion.travel_m_s);
          }};
  const std::vector<JointVector> path = shortcut_path(criteria, whole_path(from, *via, to));
  return std::vector<JointVector>(path.begin() + 1, path.end() - 1);
}

}  // namespace calib
