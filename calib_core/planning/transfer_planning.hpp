#pragma once

#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/planning_problem.hpp"

namespace calib {

/// Intermediate postures of a short path of straight joint moves from `from` to `to` that keeps the nominal
/// position error to the scene; empty when the direct move is clear, nothing when no path is found. At most
/// kTransferPosturesMax. See find_path and shortcut_path.
std::optional<std::vector<JointVector>> find_transfer(const PlanningProblem& problem, const JointVector& from,
                                                      const JointVector& to);

}  // namespace calib
