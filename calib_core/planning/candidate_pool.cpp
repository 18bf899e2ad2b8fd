#include "calib_core/planning/candidate_pool.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

#include "calib_core/kinematics/inverse_kinematics.hpp"

namespace calib {
namespace {

/// Poses tried per wanted candidate.
constexpr int kPosesPerCandidate = 20;
/// The fraction of poses on the rim. 20,000 such candidates are as good as 80,000 uniformly distributed ones.
constexpr double kRimShare = 0.7;
/// Poses between two reports of progress.
constexpr int kPosesPerReport = 256;

/// The posture, changed by full turns, that is nearest to `wanted` within the ranges; nothing when there is
/// none.
std::optional<JointVector> wrap_into(const JointRanges& ranges, const JointVector& turns,
                                     const JointVector& wanted, JointVector joints) {
  for (int joint = 0; joint < kJointCount; ++joint) {
    const double turn = turns[joint];
    double& angle = joints[joint];
    angle += turn * std::nearbyint((wanted[joint] - angle) / turn);
    if (angle < ranges.lower[joint]) angle += turn * std::ceil((ranges.lower[joint] - angle) / turn);
    if (angle > ranges.upper[joint]) angle -= turn * std::ceil((angle - ranges.upper[joint]) / turn);
  }
  return ranges.contains(joints) ? std::optional(joints) : std::nullopt;
}

/// Why a pose has no posture at all.
std::string no_posture(const KinematicModel& arm) {
  const auto slides = std::ranges::find(arm.joint_types, JointType::kPrismatic);
  if (slides == arm.joint_types.end()) return "out of reach";
  return "joint " + std::to_string(slides - arm.joint_types.begin() + 1) +
         " is prismatic, postures are found for six revolute joints only";
}

/// What a tip can touch.
struct TipReach {
  PlanningProblem problem;  // for_tip_of()
  TouchMaker maker{problem};
};

/// One of each tip that a face is wanted to be touched by.
class TipReaches {
 public:
  explicit TipReaches(const PlanningProblem& problem) : problem_(problem) {}

  const TipReach& of(int face) {
    auto& reach = of_tip_[problem_.knowledge.artefact.tip_of(static_cast<std::size_t>(face))];
    if (!reach) reach = std::make_unique<TipReach>(for_tip_of(problem_, face));
    return *reach;
  }

 private:
  const PlanningProblem& problem_;
  std::map<std::size_t, std::unique_ptr<TipReach>> of_tip_;
};

/// Tries random poses of one face.
class FaceSearch {
 public:
  FaceSearch(const TipReach& reach, int face, UniformChance& chance)
      : problem_(reach.problem),
        maker_(reach.maker),
        target_(find_target(reach.problem, face)),
        chance_(chance) {
    effort_.face = face;
  }

  void try_pose(std::vector<TouchCandidate>& candidates) {
    ++poses_;
    const TouchPose pose = sample_touch_pose(problem_, problem_.faces[static_cast<std::size_t>(effort_.face)],
                                             chance_, kRimShare);
    const Postures branches = maker_.inverse().solve(pose.block_from_tip);
    int in_range = 0;
    for (const JointVector& branch : branches) {
      const auto joints =
          wrap_into(problem_.joint_ranges, maker_.inverse().turns(), problem_.park_joints, branch);
      if (!joints) continue;
      ++in_range;
      ++effort_.tried;
      const auto touch = maker_.make(target_, pose, *joints);
      if (const auto* infeasibility = std::get_if<TouchInfeasibility>(&touch)) {
        ++infeasibilities_[*infeasibility];
      } else {
        ++effort_.feasible;
        candidates.push_back({effort_.face, pose, *joints, std::get<PlannedTouch>(touch).clear_joints});
      }
    }
    if (in_range > 0) return;
    ++effort_.tried;
    ++(branches.empty() ? out_of_reach_ : out_of_ranges_);
  }

  [[nodiscard]] int poses() const { return poses_; }
  [[nodiscard]] int feasible() const { return effort_.feasible; }

  [[nodiscard]] FaceEffort effort() const {
    std::map<std::string, int> counts;  // causes with the same text are counted together
    for (const auto& [infeasibility, count] : infeasibilities_)
      counts[describe(problem_, infeasibility)] += count;
    if (out_of_reach_ > 0) counts[no_posture(problem_.nominal)] += out_of_reach_;
    if (out_of_ranges_ > 0) counts["joint ranges"] += out_of_ranges_;
    FaceEffort effort = effort_;
    for (const auto& [reason, count] : counts) effort.obstructions.push_back({reason, count});
    std::ranges::stable_sort(effort.obstructions, std::ranges::greater{}, &Obstruction::count);
    return effort;
  }

 private:
  const PlanningProblem& problem_;
  const TouchMaker& maker_;
  TouchTarget target_;
  UniformChance& chance_;
  int poses_ = 0, out_of_reach_ = 0, out_of_ranges_ = 0;
  FaceEffort effort_;
  std::map<TouchInfeasibility, int> infeasibilities_;
};

}  // namespace

CandidatePool find_candidates(const PlanningProblem& problem, const PlanningProgress& progress) {
  TipReaches reaches(problem);
  UniformChance chance(problem.seed);
  std::vector<FaceSearch> searches;
  for (const TouchRequest& request : problem.requests) {
    if (request.face < 0 || static_cast<std::size_t>(request.face) >= problem.faces.size()) {
      throw std::logic_error("touches are wanted on a face that does not exist");
    }
    searches.emplace_back(reaches.of(request.face), request.face, chance);
  }

  CandidatePool pool;
  const auto missing = [&] { return problem.candidate_count - static_cast<int>(pool.candidates.size()); };
  std::vector<FaceSearch*> open;  // those that may find more
  for (FaceSearch& search : searches) open.push_back(&search);
  while (missing() > 0 && !open.empty()) {
    const int share = (missing() + static_cast<int>(open.size()) - 1) / static_cast<int>(open.size());
    std::vector<FaceSearch*> next;
    for (FaceSearch* search : open) {
      const int poses_max = kPosesPerCandidate * (search->feasible() + share);
      const int wanted = search->feasible() + share;
      while (search->feasible() < wanted && search->poses() < poses_max) {
        search->try_pose(pool.candidates);
        if (progress && search->poses() % kPosesPerReport == 0) {
          progress("candidates",
                   1.0 - std::max(missing(), 0) / static_cast<double>(std::max(problem.candidate_count, 1)));
        }
      }
      if (search->feasible() >= wanted) next.push_back(search);
    }
    open = std::move(next);
  }
  for (const FaceSearch& search : searches) pool.efforts.push_back(search.effort());
  return pool;
}

}  // namespace calib
