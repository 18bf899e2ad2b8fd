#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "calib_core/geometry/joint_vector.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/planning_problem.hpp"

namespace calib {

/// The begin or end of a transfer.
struct TransferEnd {
  JointVector joints;
  std::optional<Eigen::Vector3d> outward;  // direction in which its touch leaves the face
  const PlanningProblem* made_with =
      nullptr;  // has a clear path to park; null: the nominal problem. Not owned.
};
TransferEnd transfer_end_of(const AimedTouch& touch);

inline constexpr std::size_t kAimedTransferPosturesMax = 5;

/// find_transfer with the estimate of the arm; keeps the largest predicted position error along the path. An
/// end that is closer to its face than that (a touch has shown where the face is) is left first, or reached
/// last, along `outward`. At most kAimedTransferPosturesMax postures.
std::optional<std::vector<JointVector>> find_aimed_transfer(const PlanningProblem& problem,
                                                            const OnlineArmEstimate& estimate,
                                                            const TransferEnd& from, const TransferEnd& to);

}  // namespace calib
