#include "calib_core/planning/touch_planning.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/internal/optimal_design.hpp"
#include "calib_core/planning/online_estimate.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_order.hpp"

namespace calib {
namespace {

/// Approximate shares of the computing time.
constexpr double kPoolShare = 0.4;
constexpr double kChoiceShare = 0.5;

std::string most_frequent_obstruction(const FaceEffort& effort) {
  return effort.obstructions.empty() ? "no posture was tried" : effort.obstructions.front().reason;
}

/// The first face with fewer feasible touches than it needs; nothing when all have enough.
std::optional<PlanningFailure> find_shortage(const PlanningProblem& problem, const CandidatePool& pool) {
  int available = 0;
  for (std::size_t i = 0; i < problem.requests.size(); ++i) {
    const TouchRequest& request = problem.requests[i];
    const FaceEffort& effort = pool.efforts[i];
    if (effort.feasible < request.fit_min + request.held_out_count) {
      return PlanningFailure{.kind = PlanningFailure::Kind::kFace,
                             .face = request.face,
                             .found = effort.feasible,
                             .wanted = request.fit_min + request.held_out_count,
                             .reason = most_frequent_obstruction(effort),
                             .efforts = pool.efforts};
    }
    available += std::min(request.fit_max, effort.feasible - request.held_out_count);
  }
  if (available >= problem.goal.fit_count) return std::nullopt;
  const auto scarcest = std::ranges::min_element(pool.efforts, {}, &FaceEffort::feasible);
  return PlanningFailure{.kind = PlanningFailure::Kind::kFace,
                         .face = scarcest->face,
                         .found = available,
                         .wanted = problem.goal.fit_count,
                         .reason = most_frequent_obstruction(*scarcest),
                         .efforts = pool.efforts};
}

PlannedTouch complete_touch(const PlanningProblem& problem, const TouchCandidate& candidate, TouchRole role) {
  const TouchTarget target = find_target(problem, candidate.face);
  auto touch = make_touch(problem, target, candidate.pose, candidate.joints);
  if (const auto* reason = std::get_if<std::string>(&touch))
    throw std::logic_error("a candidate is infeasible: " + *reason);
  auto& planned = std::get<PlannedTouch>(touch);
  planned.role = role;
  return std::move(planned);
}

std::vector<PlannedTouch> complete_touches(const PlanningProblem& problem,
                                           const std::vector<TouchCandidate>& candidates,
                                           const TouchChoice& choice) {
  std::vector<PlannedTouch> touches;
  for (const std::size_t index : choice.fit)
    touches.push_back(complete_touch(problem, candidates[index], TouchRole::kFit));
  for (const std::size_t index : choice.held_out)
    touches.push_back(complete_touch(problem, candidates[index], TouchRole::kHeldOut));
  return touches;
}

/// Sizes clearance and search of each touch by its predicted position error and those of its neighbours.
void resize_touches(const PlanningProblem& problem, std::vector<PlannedTouch>& touches) {
  const std::vector<double> errors_m = predicted_position_errors_m(problem, touches);
  PlanningProblem aimed = problem;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, touches.size() - 1);
    aimed.nominal_position_error_m = std::max({errors_m[before], errors_m[i], errors_m[after]});
    if (aimed.nominal_position_error_m == problem.nominal_position_error_m) continue;
    aimed.standoff_min_m = kAimedStandoffMinMetres;
    auto smaller = nominal_touch(aimed, touches[i]);
    if (auto* touch = std::get_if<AimedTouch>(&smaller)) touches[i] = std::move(touch->touch);
    // else the touch keeps its size, which is larger than necessary
  }
}

PlanningProgress part(const PlanningProgress& progress, double begin, double share) {
  if (!progress) return {};
  return [&progress, begin, share](std::string_view stage, double done) {
    progress(stage, begin + share * done);
  };
}

}  // namespace

std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem,
                                                      const PlanningProgress& progress) {
  const Chain parked = forward_chain(problem.nominal, problem.park_joints);
  if (const auto clash = find_clash(travel_scene(problem), parked, problem.nominal_position_error_m)) {
    return PlanningFailure{
        .kind = PlanningFailure::Kind::kPark,
        .reason = "the " + clash->body + " is too near the " + clash->other + " in the park posture"};
  }
  CandidatePool pool = find_candidates(problem, part(progress, 0.0, kPoolShare));
  if (auto failure = find_shortage(problem, pool)) return std::move(*failure);

  const PlanningProgress choosing = part(progress, kPoolShare, kChoiceShare);
  const auto choice = choose_touches(problem, pool.candidates, [&choosing](double done) {
    if (choosing) choosing("choosing the touches", done);
  });
  if (const auto* failure = std::get_if<ChoiceFailure>(&choice)) {
    const bool unidentifiable = failure->kind == ChoiceFailure::Kind::kUnidentifiable;
    return PlanningFailure{
        .kind = unidentifiable ? PlanningFailure::Kind::kUnidentifiable : PlanningFailure::Kind::kAccuracy,
        .wanted = problem.goal.fit_count,
        .best_tip_rms_m = failure->best_tip_rms_m,
        .reason = failure->reason,
        .efforts = std::move(pool.efforts)};
  }
  if (progress) progress("ordering the touches", kPoolShare + kChoiceShare);
  auto touches =
      order_touches(problem, complete_touches(problem, pool.candidates, std::get<TouchChoice>(choice)));
  resize_touches(problem, touches);
  auto plan = find_paths(problem, std::move(touches));
  if (!plan) throw std::logic_error("a touch that reaches the park posture has no path to the next one");
  plan->efforts = std::move(pool.efforts);
  if (progress) progress("ordering the touches", 1.0);
  return std::move(*plan);
}

}  // namespace calib
