#include "calib_core/candidate_pool.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "calib_core/inverse_kinematics.hpp"

namespace calib {
namespace {

/// Poses tried for each candidate wanted.
constexpr int kPosesPerCandidate = 20;
/// Of the poses, those on the rim of what may be touched. 20,000 such candidates are as good as 80,000 even
/// ones.
constexpr double kRimShare = 0.7;
/// Poses between two reports of progress.
constexpr int kPosesInARow = 256;

bool differ_by_whole_turns(const JointVector& a, const JointVector& b) {
  constexpr double kSameRad = 1e-6;
  return std::ranges::all_of(JointVector(a - b), [](double difference) {
    return std::abs(std::remainder(difference, 2.0 * std::numbers::pi)) < kSameRad;
  });
}

/// One posture a branch: of those that differ by whole turns only the one nearest to the park posture.
std::vector<JointVector> postures_of(const PlanningProblem& problem, const TouchPose& pose) {
  std::vector<JointVector> all =
      inverse_kinematics(problem.nominal, problem.joint_ranges, pose.block_from_tip);
  std::ranges::stable_sort(all, {},
                           [&](const JointVector& joints) { return (joints - problem.park_joints).norm(); });
  std::vector<JointVector> branches;
  for (const JointVector& joints : all) {
    const bool is_new = std::ranges::none_of(
        branches, [&](const JointVector& branch) { return differ_by_whole_turns(joints, branch); });
    if (is_new) branches.push_back(joints);
  }
  return branches;
}

std::string why_no_posture(const PlanningProblem& problem, const TouchPose& pose) {
  const JointVector half_turn = JointVector::Constant(std::numbers::pi);
  const bool reachable =
      !inverse_kinematics(problem.nominal, {-half_turn, half_turn}, pose.block_from_tip).empty();
  return reachable ? "joint ranges" : "out of reach";
}

/// Tries poses of one face.
class FaceSearch {
 public:
  FaceSearch(const PlanningProblem& problem, int face, UniformChance& chance)
      : problem_(problem), face_(face), around_(find_touched(problem, face)), chance_(chance) {}

  void try_pose(std::vector<TouchCandidate>& candidates) {
    ++poses_;
    const TouchPose pose =
        sample_touch_pose(problem_, problem_.faces[static_cast<std::size_t>(face_)], chance_, kRimShare);
    const auto postures = postures_of(problem_, pose);
    if (postures.empty()) refuse(why_no_posture(problem_, pose));
    for (const JointVector& joints : postures) {
      const auto touch = make_touch(problem_, around_, pose, joints);
      if (const auto* trouble = std::get_if<std::string>(&touch)) {
        refuse(*trouble);
      } else {
        ++tried_;
        ++feasible_;
        candidates.push_back({face_, pose, joints, std::get<PlannedTouch>(touch).clear_joints});
      }
    }
  }

  [[nodiscard]] int poses() const { return poses_; }
  [[nodiscard]] int feasible() const { return feasible_; }

  [[nodiscard]] FaceEffort effort() const {
    FaceEffort effort{.face = face_, .tried = tried_, .feasible = feasible_};
    for (const auto& [reason, count] : troubles_) effort.obstructions.push_back({reason, count});
    std::ranges::stable_sort(effort.obstructions, std::ranges::greater{}, &Obstruction::count);
    return effort;
  }

 private:
  void refuse(const std::string& trouble) {
    ++tried_;
    ++troubles_[trouble];
  }

  const PlanningProblem& problem_;
  int face_;
  TouchedFace around_;
  UniformChance& chance_;
  int poses_ = 0, tried_ = 0, feasible_ = 0;
  std::map<std::string, int> troubles_;
};

}  // namespace

CandidatePool find_candidates(const PlanningProblem& problem, const PlanningProgress& progress) {
  UniformChance chance(problem.seed);
  std::vector<FaceSearch> searches;
  for (const TouchRequest& request : problem.requests) {
    if (request.face < 0 || static_cast<std::size_t>(request.face) >= problem.faces.size()) {
      throw std::logic_error("touches are wanted on a face that does not exist");
    }
    searches.emplace_back(problem, request.face, chance);
  }

  CandidatePool pool;
  const auto missing = [&] { return problem.candidate_count - static_cast<int>(pool.candidates.size()); };
  std::vector<FaceSearch*> open;  // that may find more
  for (FaceSearch& search : searches) open.push_back(&search);
  while (missing() > 0 && !open.empty()) {
    const int share = (missing() + static_cast<int>(open.size()) - 1) / static_cast<int>(open.size());
    std::vector<FaceSearch*> next;
    for (FaceSearch* search : open) {
      const int poses_max = kPosesPerCandidate * (search->feasible() + share);
      const int wanted = search->feasible() + share;
      while (search->feasible() < wanted && search->poses() < poses_max) {
        search->try_pose(pool.candidates);
        if (progress && search->poses() % kPosesInARow == 0) {
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
