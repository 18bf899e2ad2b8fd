#include "calib_core/touch_planning.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <stdexcept>

#include "calib_core/error_parameters.hpp"
#include "calib_core/inverse_kinematics.hpp"
#include "calib_core/swept_collision.hpp"
#include "calib_core/touch_candidate.hpp"
#include "calib_core/touch_selection.hpp"

namespace calib {
namespace {

/// How many possible touches a face is given to choose from, and how many poses are tried for them.
constexpr int kCandidatesPerTouch = 64;
constexpr int kCandidatesMin = 240;
constexpr int kPosesPerCandidate = 20;

int candidates_wanted(const TouchRequest& request) {
  return std::max(kCandidatesPerTouch * (request.fit_max + request.held_out_count), kCandidatesMin);
}

/// The even share of a face whose number is free.
int fit_count(const PlanningProblem& problem, const TouchRequest& request) {
  return std::clamp(problem.goal.fit_count / static_cast<int>(problem.requests.size()), request.fit_min,
                    request.fit_max);
}

/// How often each thing stood in the way.
class Troubles {
 public:
  void add(const std::string& trouble) { ++counts_[trouble]; }
  [[nodiscard]] std::string most_frequent() const {
    const auto most = std::ranges::max_element(counts_, {}, [](const auto& entry) { return entry.second; });
    return most == counts_.end() ? "no touches were tried" : most->first;
  }

 private:
  std::map<std::string, int> counts_;
};

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

std::vector<PlannedTouch> find_candidates(const PlanningProblem& problem, const TouchRequest& request,
                                          UniformChance& chance, Troubles& troubles) {
  const Face& face = problem.faces[static_cast<std::size_t>(request.face)];
  const TouchedFace around = find_touched(problem, request.face);
  const auto wanted = static_cast<std::size_t>(candidates_wanted(request));
  std::vector<PlannedTouch> candidates;
  for (std::size_t pose = 0; pose < kPosesPerCandidate * wanted && candidates.size() < wanted; ++pose) {
    const TouchPose tried = sample_touch_pose(problem, face, chance);
    const auto postures = postures_of(problem, tried);
    if (postures.empty()) troubles.add(why_no_posture(problem, tried));
    for (const JointVector& joints : postures) {
      auto touch = make_touch(problem, around, tried, joints);
      if (const auto* trouble = std::get_if<std::string>(&touch)) {
        troubles.add(*trouble);
      } else {
        candidates.push_back(std::get<PlannedTouch>(std::move(touch)));
      }
    }
  }
  return candidates;
}

/// Rows of the observation matrix: d signed distance / d error.
Eigen::MatrixXd observation_rows(const PlanningProblem& problem, const std::vector<PlannedTouch>& touches) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(touches.size()), kErrorParameterCount);
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Chain chain = forward_chain(problem.nominal, touches[i].joints);
    rows.row(static_cast<Eigen::Index>(i)) =
        -touches[i].search_direction.transpose() * tip_derivatives(problem.nominal, chain);
  }
  return rows;
}

/// What makes touches of a face alike: the place on the face in quarters of its extents, the direction of the
/// stylus, and joints 1 to 3 in radians. The turn about the stylus is left out: it tells nothing.
Eigen::MatrixXd touch_features(const PlanningProblem& problem, const std::vector<PlannedTouch>& touches) {
  Eigen::MatrixXd features(8, static_cast<Eigen::Index>(touches.size()));
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Face& face = problem.faces[static_cast<std::size_t>(touches[i].face)];
    const Eigen::Isometry3d block_from_tip = forward_kinematics(problem.nominal, touches[i].joints);
    const Eigen::Vector3d from_center_m = block_from_tip.translation() - face.center_m;
    const Eigen::Vector2d quarter_m = 0.5 * face.half_extent_m;
    features.col(static_cast<Eigen::Index>(i)) << from_center_m.dot(face.edge_u) / quarter_m.x(),
        from_center_m.dot(face.edge_v()) / quarter_m.y(), block_from_tip.linear().col(2),
        touches[i].joints.head<3>();
  }
  return features;
}

double travel_rad(const PlannedTouch& from, const PlannedTouch& to) {
  return (to.clear_joints - from.clear_joints).cwiseAbs().maxCoeff();
}

/// From the given place on, each time the nearest touch among those still due on the same face.
void shorten_travel(std::vector<PlannedTouch>& touches, std::size_t begin, std::size_t end) {
  for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) {
    std::size_t nearest = i;
    for (std::size_t j = i + 1; j < end; ++j) {
      const bool same_face = touches[j].face == touches[i].face;
      if (same_face &&
          travel_rad(touches[i - 1], touches[j]) < travel_rad(touches[i - 1], touches[nearest])) {
        nearest = j;
      }
    }
    std::swap(touches[i], touches[nearest]);
  }
}

TouchPlan choose(const PlanningProblem& problem, const std::vector<PlannedTouch>& candidates) {
  std::vector<int> faces;
  for (const PlannedTouch& candidate : candidates) faces.push_back(candidate.face);
  std::vector<Quota> fit_quotas, held_out_quotas;
  for (const TouchRequest& request : problem.requests) {
    fit_quotas.push_back({request.face, fit_count(problem, request)});
    held_out_quotas.push_back({request.face, request.held_out_count});
  }
  const Eigen::MatrixXd rows = observation_rows(problem, candidates);
  const auto fit = order_by_information(rows, faces, fit_quotas, select_informative(rows, faces, fit_quotas));
  const auto held_out = select_apart(touch_features(problem, candidates), faces, held_out_quotas, fit);

  TouchPlan plan;
  for (const auto& [indices, role] :
       {std::pair(fit, TouchRole::kFit), std::pair(held_out, TouchRole::kHeldOut)}) {
    for (const std::size_t index : indices) {
      plan.touches.push_back(candidates[index]);
      plan.touches.back().role = role;
    }
  }
  // As many touches as there are parameters come by information, the others by the way between them.
  shorten_travel(plan.touches, std::min<std::size_t>(fit.size(), kErrorParameterCount), fit.size());
  shorten_travel(plan.touches, fit.size(), plan.touches.size());
  return plan;
}

}  // namespace

CollisionScene travel_scene(const PlanningProblem& problem) {
  CollisionScene scene = problem.scene;
  const Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  scene.bodies.push_back({"tip", kFrameCount - 1, tip, tip, problem.stylus.radius_m});
  for (Capsule& body : scene.bodies) {
    if (body.frame == kFrameCount - 1) body.margin_m += kSlowZoneMetres + kSweptErrorMaxMetres;
  }
  return scene;
}

double TouchPlan::duration_s() const {
  double sum = park_s;
  for (const PlannedTouch& touch : touches) sum += touch.travel_s + touch.touch_s;
  return sum;
}

std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem,
                                                      const PlanningProgress&) {
  const Chain parked = forward_chain(problem.nominal, problem.park_joints);
  if (const auto clash = find_clash(travel_scene(problem), parked, problem.nominal_miss_m)) {
    return PlanningFailure{
        .kind = PlanningFailure::Kind::kPark,
        .reason = "the " + clash->body + " is too near the " + clash->other + " in the park posture"};
  }
  UniformChance chance(problem.seed);
  std::vector<PlannedTouch> candidates;
  for (const TouchRequest& request : problem.requests) {
    if (request.face < 0 || static_cast<std::size_t>(request.face) >= problem.faces.size()) {
      throw std::logic_error("touches are wanted on a face that does not exist");
    }
    Troubles troubles;
    std::vector<PlannedTouch> found = find_candidates(problem, request, chance, troubles);
    const int wanted = fit_count(problem, request) + request.held_out_count;
    if (static_cast<int>(found.size()) < wanted) {
      return PlanningFailure{.face = request.face,
                             .found = static_cast<int>(found.size()),
                             .wanted = wanted,
                             .reason = troubles.most_frequent()};
    }
    std::ranges::move(found, std::back_inserter(candidates));
  }
  return choose(problem, candidates);
}

std::optional<std::vector<JointVector>> find_transfer(const PlanningProblem& problem, const JointVector& from,
                                                      const JointVector& to) {
  const CollisionScene scene = travel_scene(problem);
  return find_way({problem.nominal, scene, problem.park_joints, problem.nominal_miss_m}, from, to);
}

}  // namespace calib
