#include "calib_core/planning/aimed_transfer.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/swept_collision.hpp"
#include "calib_core/motion/transfer_path.hpp"
#include "calib_core/planning/transfer_planning.hpp"

namespace calib {
namespace {

bool is_clear(const PlanningProblem& problem, const CollisionScene& scene, const JointVector& joints,
              double clearance_m) {
  return !find_clash(scene, forward_chain(problem.nominal, joints), clearance_m);
}

/// The posture of the end itself when it is clear, else the nearest clear posture along the normal, when the
/// move there comes no closer to obstacles than the end itself.
std::optional<JointVector> lift_to_clear(const PlanningProblem& problem, const TransferEnd& end) {
  const CollisionScene scene = travel_scene(problem);
  if (is_clear(problem, scene, end.joints, problem.nominal_position_error_m)) return end.joints;
  if (!end.outward) return std::nullopt;
  // Without the slow zone: the arm is inside it.
  double kept_m = problem.nominal_position_error_m;
  while (kept_m > 0.0 && !is_clear(problem, problem.scene, end.joints, kept_m))
    kept_m -= kSweptErrorMaxMetres;
  const Eigen::Isometry3d here = forward_kinematics(problem.nominal, end.joints);
  constexpr int kLiftsMax = 20;
  constexpr double kLiftMetres = 0.004;
  JointVector joints = end.joints;
  for (int lift = 1; lift <= kLiftsMax; ++lift) {
    Eigen::Isometry3d higher = here;
    higher.pretranslate(lift * kLiftMetres * *end.outward);
    const auto next = solve_near(problem.nominal, higher, joints);
    if (!next || !problem.joint_ranges.contains(*next)) return std::nullopt;
    joints = *next;
    if (find_clash_on_move(problem.scene, problem.nominal, end.joints, joints,
                           std::max(0.0, kept_m - kSweptErrorMaxMetres))) {
      return std::nullopt;
    }
    if (is_clear(problem, scene, joints, problem.nominal_position_error_m)) return joints;
  }
  return std::nullopt;
}

std::optional<std::vector<JointVector>> find_lifted_transfer(const PlanningProblem& problem,
                                                             const TransferEnd& from, const TransferEnd& to) {
  const auto begin = lift_to_clear(problem, from);
  if (!begin) return std::nullopt;
  const auto end = lift_to_clear(problem, to);
  if (!end) return std::nullopt;
  auto path = find_transfer(problem, *begin, *end);
  if (!path) return std::nullopt;
  if (*begin != from.joints) path->insert(path->begin(), *begin);
  if (*end != to.joints) path->push_back(*end);
  if (path->size() > kAimedTransferPosturesMax) return std::nullopt;
  return path;
}

/// Postures at regular distances along a path, ends included.
std::vector<JointVector> sample_path(const JointVector& from, const std::vector<JointVector>& via,
                                     const JointVector& to) {
  constexpr double kStepRad = 10.0 * kRadiansPerDegree;
  const std::vector<JointVector> stops = whole_path(from, via, to);
  std::vector<JointVector> postures{from};
  for (std::size_t leg = 1; leg < stops.size(); ++leg) {
    const JointVector move = stops[leg] - stops[leg - 1];
    const int steps = static_cast<int>(std::ceil(move.cwiseAbs().maxCoeff() / kStepRad));
    for (int step = 1; step <= steps; ++step) postures.push_back(stops[leg - 1] + move * step / steps);
  }
  return postures;
}

/// Through park, on the paths that were checked when the ends were computed.
std::optional<std::vector<JointVector>> through_park(const PlanningProblem& problem, const TransferEnd& from,
                                                     const TransferEnd& to) {
  auto path = find_transfer(from.made_with ? *from.made_with : problem, from.joints, problem.park_joints);
  const auto in = find_transfer(to.made_with ? *to.made_with : problem, problem.park_joints, to.joints);
  if (!path || !in || path->size() + 1 + in->size() > kAimedTransferPosturesMax) return std::nullopt;
  path->push_back(problem.park_joints);
  path->insert(path->end(), in->begin(), in->end());
  return path;
}

}  // namespace

TransferEnd transfer_end_of(const AimedTouch& touch) {
  return {touch.touch.clear_joints, -touch.touch.search_direction, &touch.problem};
}

std::optional<std::vector<JointVector>> find_aimed_transfer(const PlanningProblem& problem,
                                                            const OnlineArmEstimate& estimate,
                                                            const TransferEnd& from, const TransferEnd& to) {
  std::vector<JointVector> postures{from.joints, to.joints};
  constexpr int kTriesMax = 3;
  for (int attempt = 0; attempt < kTriesMax; ++attempt) {
    const auto aimed = estimate.aimed_problem(problem, postures);
    const double error_m = aimed ? aimed->nominal_position_error_m : problem.nominal_position_error_m;
    auto path = find_lifted_transfer(aimed ? *aimed : problem, from, to);
    if (!path) break;
    const std::size_t known = postures.size();
    for (const JointVector& joints : sample_path(from.joints, *path, to.joints)) {
      if (estimate.predicted_position_error_m(joints) > error_m) postures.push_back(joints);
    }
    if (postures.size() == known) return path;
  }
  return through_park(problem, from, to);
}

}  // namespace calib
