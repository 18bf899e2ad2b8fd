#include "calib_core/qualification/qualification_planning.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/motion/collision.hpp"
#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_order.hpp"
#include "calib_core/qualification/qualification.hpp"

namespace calib {
namespace {

/// The place of the turns is looked for among so many of the farthest leaning.
constexpr std::size_t kTurningPlacesMax = 60;
/// A touch of a length is no turn: turned_touches() tells them apart with room to spare.
constexpr double kApartMetres = 0.03;

/// Makes the touches of one problem.
class QualifyingTouches {
 public:
  explicit QualifyingTouches(const PlanningProblem& problem) : problem_(problem), maker_(problem) {}

  [[nodiscard]] std::optional<PlannedTouch> whole(int face, const TouchPose& pose,
                                                  const JointVector& joints) const {
    auto made = maker_.make(find_target(problem_, face), pose, joints);
    if (std::holds_alternative<TouchInfeasibility>(made)) return std::nullopt;
    PlannedTouch touch = std::get<PlannedTouch>(std::move(made));
    touch.role = TouchRole::kProof;
    touch.predicted_position_error_m = problem_.nominal_position_error_m;
    return touch;
  }

  /// The turns of a candidate, itself first, then by joint 6; how far it came where one is infeasible.
  [[nodiscard]] std::vector<PlannedTouch> turns(const TouchCandidate& candidate) {
    std::vector<PlannedTouch> made;
    for (int turn = 0; turn < kTurnCount; ++turn) {
      TouchPose pose = candidate.pose;
      pose.block_from_tip.rotate(
          Eigen::AngleAxisd(turn * 2.0 * std::numbers::pi / kTurnCount, Eigen::Vector3d::UnitZ()));
      const auto joints = turn == 0 ? candidate.joints : nearest_posture(pose, candidate.joints);
      if (joints && arm_move_rad(*joints, candidate.joints) > kTurningArmMoveMaxRadians) {
        arm_moves_ = true;
        return made;
      }
      auto touch = joints ? whole(candidate.face, pose, *joints) : std::nullopt;
      if (!touch) return made;
      made.push_back(*std::move(touch));
    }
    std::sort(made.begin() + 1, made.end(), [](const PlannedTouch& one, const PlannedTouch& other) {
      return one.joints[kJointCount - 1] < other.joints[kJointCount - 1];
    });
    return made;
  }

  /// Whether a turn was given up because the whole arm would move for it.
  [[nodiscard]] bool arm_moves() const { return arm_moves_; }

 private:
  static double arm_move_rad(const JointVector& one, const JointVector& other) {
    return (one - other).head<kJointCount - 1>().cwiseAbs().maxCoeff();
  }

  /// Of all postures of the pose the one whose joints 1 to 5 are nearest, and of these whose joint 6 is
  /// nearest to its park posture.
  [[nodiscard]] std::optional<JointVector> nearest_posture(const TouchPose& pose,
                                                           const JointVector& joints) const {
    std::optional<JointVector> nearest;
    double least = std::numeric_limits<double>::infinity();
    for (const JointVector& posture :
         inverse_kinematics(problem_.nominal, problem_.joint_ranges, pose.block_from_tip)) {
      const double arm = (posture - joints).head<kJointCount - 1>().norm();
      const double last = std::abs(posture[kJointCount - 1] - problem_.park_joints[kJointCount - 1]);
      constexpr double kArmFirst = 1e3;
      if (kArmFirst * arm + last >= least) continue;
      least = kArmFirst * arm + last;
      nearest = posture;
    }
    return nearest;
  }

  const PlanningProblem& problem_;
  TouchMaker maker_;
  bool arm_moves_ = false;
};

/// Candidates on flat faces, the farthest leaning first.
std::vector<TouchCandidate> leaning(const PlanningProblem& problem, const CandidatePool& pool) {
  std::vector<TouchCandidate> found;
  for (const TouchCandidate& candidate : pool.candidates) {
    const bool is_flat = problem.faces[static_cast<std::size_t>(candidate.face)].is_flat();
    if (is_flat && candidate.pose.tilt_rad >= kQualifyingLeanMinRadians) found.push_back(candidate);
  }
  std::ranges::stable_sort(found, std::greater<>(),
                           [](const TouchCandidate& candidate) { return candidate.pose.tilt_rad; });
  if (found.size() > kTurningPlacesMax) found.resize(kTurningPlacesMax);
  return found;
}

double turned_by_rad(const TouchCandidate& one, const TouchCandidate& other) {
  const Eigen::Matrix3d between =
      one.pose.block_from_tip.linear().transpose() * other.pose.block_from_tip.linear();
  return Eigen::AngleAxisd(between).angle();
}

/// A touch of either face, in postures as alike as there are; nothing where one has none.
std::optional<std::pair<TouchCandidate, TouchCandidate>> alike_postures(
    const std::vector<TouchCandidate>& candidates, const std::array<int, 2>& faces,
    const TouchCandidate& turning) {
  const auto is_apart = [&](const TouchCandidate& candidate) {
    const Eigen::Vector3d between_m =
        candidate.pose.block_from_tip.translation() - turning.pose.block_from_tip.translation();
    return candidate.face != turning.face || between_m.norm() > kApartMetres;
  };
  std::optional<std::pair<TouchCandidate, TouchCandidate>> best;
  double least_rad = std::numeric_limits<double>::infinity();
  for (const TouchCandidate& one : candidates) {
    if (one.face != faces[0] || !is_apart(one)) continue;
    for (const TouchCandidate& other : candidates) {
      if (other.face != faces[1] || !is_apart(other)) continue;
      const double turned_rad = turned_by_rad(one, other);
      if (turned_rad >= least_rad) continue;
      least_rad = turned_rad;
      best.emplace(one, other);
    }
  }
  return best;
}

/// The first turn ten times: before, between and after the others.
std::vector<PlannedTouch> with_repeats(const std::vector<PlannedTouch>& turns) {
  std::vector<PlannedTouch> touches;
  int repeats = 0;
  for (auto turn = turns.begin() + 1; turn != turns.end(); ++turn) {
    touches.push_back(turns.front());
    ++repeats;
    touches.push_back(*turn);
  }
  for (; repeats < kRepeatCount; ++repeats) touches.push_back(turns.front());
  return touches;
}

std::optional<PlanningFailure> refuse_at_once(const PlanningProblem& problem) {
  const Chain parked = forward_chain(problem.nominal, problem.park_joints);
  if (const auto clash = find_clash(travel_scene(problem), parked, problem.nominal_position_error_m))
    return PlanningFailure{
        .kind = PlanningFailure::Kind::kPark,
        .reason = "the " + clash->body + " is too near the " + clash->other + " in the park posture",
        .efforts = {}};
  const bool has_flat = std::ranges::any_of(problem.requests, [&](const TouchRequest& request) {
    return problem.faces[static_cast<std::size_t>(request.face)].is_flat();
  });
  if (has_flat) return std::nullopt;
  return PlanningFailure{.kind = PlanningFailure::Kind::kUnidentifiable,
                         .reason = "the stylus is turned about itself on a flat face, and the block has none",
                         .efforts = {}};
}

void add_length(const QualifyingTouches& maker, const std::pair<TouchCandidate, TouchCandidate>& pair,
                std::vector<PlannedTouch>& touches) {
  const auto first = maker.whole(pair.first.face, pair.first.pose, pair.first.joints);
  const auto second = maker.whole(pair.second.face, pair.second.pose, pair.second.joints);
  if (!first || !second) throw std::logic_error("a candidate is infeasible");
  for (int i = 0; i < kStepTouches; ++i) touches.insert(touches.end(), {*first, *second});
}

}  // namespace

std::variant<TouchPlan, PlanningFailure> plan_qualification(const PlanningProblem& here,
                                                            std::span<const KnownLength> lengths) {
  if (auto failure = refuse_at_once(here)) return *std::move(failure);
  CandidatePool pool = find_candidates(here);
  QualifyingTouches maker(here);
  PlanningFailure failure{.face = here.requests.front().face, .wanted = kTurnCount};
  for (const TouchCandidate& candidate : leaning(here, pool)) {
    const std::vector<PlannedTouch> turns = maker.turns(candidate);
    if (std::ssize(turns) < kTurnCount) {
      if (std::ssize(turns) > failure.found) {
        failure.found = static_cast<int>(turns.size());
        failure.face = candidate.face;
      }
      continue;
    }
    std::vector<PlannedTouch> touches = with_repeats(turns);
    for (const KnownLength& length : lengths) {
      if (const auto pair = alike_postures(pool.candidates, length.faces, candidate))
        add_length(maker, *pair, touches);
    }
    auto made = find_paths(here, std::move(touches));
    if (!made) throw std::logic_error("a touch that reaches the park posture has no path to the next one");
    made->efforts = std::move(pool.efforts);
    return std::move(*made);
  }
  failure.reason =
      maker.arm_moves()
          ? "joints 1 to 5 would move, too, as the ball is beside the axis of joint 6, and what the "
            "arm is wrong by would be taken for run-out"
          : "no posture whose stylus leans far enough can be turned about it";
  failure.efforts = std::move(pool.efforts);
  return failure;
}

}  // namespace calib
