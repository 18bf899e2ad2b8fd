#include "calib_core/planning/touch_planning.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "calib_core/motion/path_shortcut.hpp"
#include "calib_core/motion/swept_collision.hpp"
#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/internal/optimal_design.hpp"
#include "calib_core/planning/internal/touch_order.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/touch_feasibility.hpp"

namespace calib {
namespace {

/// About how the time is shared.
constexpr double kPoolShare = 0.4;
constexpr double kChoiceShare = 0.5;

std::string commonest_obstruction(const FaceEffort& effort) {
  return effort.obstructions.empty() ? "no posture was tried" : effort.obstructions.front().reason;
}

/// A face with fewer touches than it must have; nothing when there are enough of all.
std::optional<PlanningFailure> too_few(const PlanningProblem& problem, const CandidatePool& pool) {
  int left_to_fit = 0;
  for (std::size_t i = 0; i < problem.requests.size(); ++i) {
    const TouchRequest& request = problem.requests[i];
    const FaceEffort& effort = pool.efforts[i];
    if (effort.feasible < request.fit_min + request.held_out_count) {
      return PlanningFailure{.kind = PlanningFailure::Kind::kFace,
                             .face = request.face,
                             .found = effort.feasible,
                             .wanted = request.fit_min + request.held_out_count,
                             .reason = commonest_obstruction(effort),
                             .efforts = pool.efforts};
    }
    left_to_fit += std::min(request.fit_max, effort.feasible - request.held_out_count);
  }
  if (left_to_fit >= problem.goal.fit_count) return std::nullopt;
  const auto scarcest = std::ranges::min_element(pool.efforts, {}, &FaceEffort::feasible);
  return PlanningFailure{.kind = PlanningFailure::Kind::kFace,
                         .face = scarcest->face,
                         .found = left_to_fit,
                         .wanted = problem.goal.fit_count,
                         .reason = commonest_obstruction(*scarcest),
                         .efforts = pool.efforts};
}

PlannedTouch made(const PlanningProblem& problem, const TouchCandidate& candidate, TouchRole role) {
  const TouchedFace around = find_touched(problem, candidate.face);
  auto touch = make_touch(problem, around, candidate.pose, candidate.joints);
  if (const auto* trouble = std::get_if<std::string>(&touch))
    throw std::logic_error("a candidate cannot be touched: " + *trouble);
  auto& planned = std::get<PlannedTouch>(touch);
  planned.role = role;
  return std::move(planned);
}

std::vector<PlannedTouch> made(const PlanningProblem& problem, const std::vector<TouchCandidate>& candidates,
                               const TouchChoice& choice) {
  std::vector<PlannedTouch> touches;
  for (const std::size_t index : choice.fit)
    touches.push_back(made(problem, candidates[index], TouchRole::kFit));
  for (const std::size_t index : choice.held_out)
    touches.push_back(made(problem, candidates[index], TouchRole::kHeldOut));
  return touches;
}

/// Each touch as large as its predicted miss and those of its neighbours ask for.
void fit_to_misses(const PlanningProblem& problem, std::vector<PlannedTouch>& touches) {
  const std::vector<double> misses_m = predicted_misses_m(problem, touches);
  PlanningProblem aimed = problem;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, behind = std::min(i + 1, touches.size() - 1);
    aimed.nominal_miss_m = std::max({misses_m[before], misses_m[i], misses_m[behind]});
    if (aimed.nominal_miss_m == problem.nominal_miss_m) continue;
    aimed.standoff_min_m = kAimedStandoffMinMetres;
    auto smaller = nominal_touch(aimed, touches[i]);
    if (auto* touch = std::get_if<AimedTouch>(&smaller)) touches[i] = std::move(touch->touch);
    // else it stays as it is: larger than it need be
  }
}

PlanningProgress part(const PlanningProgress& progress, double begin, double share) {
  if (!progress) return {};
  return [&progress, begin, share](std::string_view stage, double done) {
    progress(stage, begin + share * done);
  };
}

}  // namespace

double TouchPlan::duration_s() const {
  double sum = park_s;
  for (const PlannedTouch& touch : touches) sum += touch.travel_s + touch.touch_s;
  return sum;
}

CollisionScene travel_scene(const PlanningProblem& problem) {
  CollisionScene scene = problem.scene;
  const Eigen::Vector3d tip = Eigen::Vector3d::Zero();
  scene.bodies.push_back({"tip", kFrameCount - 1, tip, tip, problem.stylus.radius_m});
  for (Capsule& body : scene.bodies) {
    if (body.frame == kFrameCount - 1) body.margin_m += kSlowZoneMetres + kSweptErrorMaxMetres;
  }
  return scene;
}

std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem,
                                                      const PlanningProgress& progress) {
  const Chain parked = forward_chain(problem.nominal, problem.park_joints);
  if (const auto clash = find_clash(travel_scene(problem), parked, problem.nominal_miss_m)) {
    return PlanningFailure{
        .kind = PlanningFailure::Kind::kPark,
        .reason = "the " + clash->body + " is too near the " + clash->other + " in the park posture"};
  }
  CandidatePool pool = find_candidates(problem, part(progress, 0.0, kPoolShare));
  if (auto failure = too_few(problem, pool)) return std::move(*failure);

  const PlanningProgress choosing = part(progress, kPoolShare, kChoiceShare);
  const auto choice = choose_touches(problem, pool.candidates, [&choosing](double done) {
    if (choosing) choosing("choosing the touches", done);
  });
  if (const auto* failure = std::get_if<ChoiceFailure>(&choice)) {
    const bool by_planes = failure->kind == ChoiceFailure::Kind::kPlanes;
    return PlanningFailure{
        .kind = by_planes ? PlanningFailure::Kind::kPlanes : PlanningFailure::Kind::kAccuracy,
        .wanted = problem.goal.fit_count,
        .best_tip_rms_m = failure->best_tip_rms_m,
        .reason = failure->reason,
        .efforts = std::move(pool.efforts)};
  }
  if (progress) progress("ordering the touches", kPoolShare + kChoiceShare);
  auto touches = put_in_order(problem, made(problem, pool.candidates, std::get<TouchChoice>(choice)));
  fit_to_misses(problem, touches);
  auto plan = find_ways(problem, std::move(touches));
  if (!plan) throw std::logic_error("a touch that leads to the park posture has no way to the next one");
  plan->efforts = std::move(pool.efforts);
  if (progress) progress("ordering the touches", 1.0);
  return std::move(*plan);
}

std::optional<std::vector<JointVector>> find_transfer(const PlanningProblem& problem, const JointVector& from,
                                                      const JointVector& to) {
  const TransferSpace space(problem.nominal, travel_scene(problem), problem.park_joints,
                            problem.nominal_miss_m);
  const auto via = find_way(space, from, to);
  if (!via || via->empty()) return via;
  const PreparedModel model = prepare(problem.nominal);
  const WayJudge judge{
      .is_clear = [&](const JointVector& a, const JointVector& b) { return space.is_clear(a, b); },
      .seconds =
          [&](const JointVector& a, const JointVector& b) {
            return move_time_s(model, problem.motion, a, b, problem.motion.travel_m_s);
          }};
  const std::vector<JointVector> way = tighten_way(judge, whole_way(from, *via, to));
  return std::vector<JointVector>(way.begin() + 1, way.end() - 1);
}

}  // namespace calib
