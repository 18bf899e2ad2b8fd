#include "calib_core/planning/touch_planning.hpp"

#include <algorithm>
#include <iterator>
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
std::optional<PlanningFailure> find_shortage(const PlanningProblem& whole,
                                             const std::vector<FaceEffort>& efforts) {
  int available = 0;
  for (std::size_t i = 0; i < whole.requests.size(); ++i) {
    const TouchRequest& request = whole.requests[i];
    const FaceEffort& effort = efforts[i];
    if (effort.feasible < request.fit_min + request.held_out_count) {
      return PlanningFailure{.kind = PlanningFailure::Kind::kFace,
                             .face = request.face,
                             .found = effort.feasible,
                             .wanted = request.fit_min + request.held_out_count,
                             .reason = most_frequent_obstruction(effort),
                             .efforts = efforts};
    }
    available += std::min(request.fit_max, effort.feasible - request.held_out_count);
  }
  if (available >= whole.goal.fit_count) return std::nullopt;
  const auto scarcest = std::ranges::min_element(efforts, {}, &FaceEffort::feasible);
  return PlanningFailure{.kind = PlanningFailure::Kind::kFace,
                         .face = scarcest->face,
                         .found = available,
                         .wanted = whole.goal.fit_count,
                         .reason = most_frequent_obstruction(*scarcest),
                         .efforts = efforts};
}

PlannedTouch complete_touch(const PlanningProblem& problem, const TouchCandidate& candidate, TouchRole role) {
  const PlanningProblem of_tip = for_tip_of(problem, candidate.face);
  auto touch = make_touch(of_tip, find_target(of_tip, candidate.face), candidate.pose, candidate.joints);
  if (const auto* reason = std::get_if<std::string>(&touch))
    throw std::logic_error("a candidate is infeasible: " + *reason);
  auto& planned = std::get<PlannedTouch>(touch);
  planned.role = role;
  return std::move(planned);
}

PlanningProgress part(const PlanningProgress& progress, double begin, double share) {
  if (!progress) return {};
  return [&progress, begin, share](std::string_view stage, double done) {
    progress(stage, begin + share * done);
  };
}

/// The candidates of all places, and which of them are those of each.
struct WholePool {
  std::vector<TouchCandidate> candidates;
  std::vector<std::size_t> ends;  // of each place
  std::vector<FaceEffort> efforts;

  [[nodiscard]] std::size_t place_of(std::size_t candidate) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(ends, candidate) - ends.begin());
  }
};

WholePool find_all_candidates(std::span<const PlanningProblem> places, const PlanningProgress& progress) {
  WholePool whole;
  const double share = 1.0 / static_cast<double>(places.size());
  for (const PlanningProblem& place : places) {
    const double begun = share * static_cast<double>(whole.ends.size());
    PlanningProblem sampled = place;
    sampled.candidate_count = place.candidate_count / static_cast<int>(places.size());
    CandidatePool pool = find_candidates(sampled, part(progress, begun, share));
    whole.candidates.insert(whole.candidates.end(), pool.candidates.begin(), pool.candidates.end());
    whole.ends.push_back(whole.candidates.size());
    whole.efforts.insert(whole.efforts.end(), pool.efforts.begin(), pool.efforts.end());
  }
  return whole;
}

/// The first place's problem with the requests of all.
PlanningProblem whole_problem(std::span<const PlanningProblem> places) {
  PlanningProblem whole = places.front();
  for (const PlanningProblem& place : places.subspan(1))
    whole.requests.insert(whole.requests.end(), place.requests.begin(), place.requests.end());
  return whole;
}

/// The chosen touches of each place.
std::vector<std::vector<PlannedTouch>> complete_touches(std::span<const PlanningProblem> places,
                                                        const WholePool& pool, const TouchChoice& choice) {
  std::vector<std::vector<PlannedTouch>> touches(places.size());
  const auto complete = [&](const std::vector<std::size_t>& chosen, TouchRole role) {
    for (const std::size_t index : chosen) {
      const std::size_t place = pool.place_of(index);
      touches[place].push_back(complete_touch(places[place], pool.candidates[index], role));
    }
  };
  complete(choice.fit, TouchRole::kFit);
  complete(choice.held_out, TouchRole::kHeldOut);
  return touches;
}

/// Sizes clearance and search of each touch by its predicted position error and those of its neighbours; the
/// touches at the places before tell of the arm as well.
void resize_touches(const PlanningProblem& problem, const std::vector<PlannedTouch>& before,
                    std::vector<PlannedTouch>& touches) {
  std::vector<PlannedTouch> so_far = before;
  so_far.insert(so_far.end(), touches.begin(), touches.end());
  std::vector<double> errors_m = predicted_position_errors_m(problem, so_far);
  errors_m.erase(errors_m.begin(), errors_m.begin() + std::ssize(before));
  PlanningProblem aimed = problem;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const std::size_t previous = i == 0 ? 0 : i - 1, next = std::min(i + 1, touches.size() - 1);
    aimed.nominal_position_error_m = std::max({errors_m[previous], errors_m[i], errors_m[next]});
    if (aimed.nominal_position_error_m == problem.nominal_position_error_m) continue;
    aimed.standoff_min_m = kAimedStandoffMinMetres;
    auto smaller = nominal_touch(aimed, touches[i]);
    if (auto* touch = std::get_if<AimedTouch>(&smaller)) touches[i] = std::move(touch->touch);
    // else the touch keeps its size, which is larger than necessary
  }
}

/// Appends the touches at a place, with the way to them and back.
void append(TouchPlan&& there, TouchPlan& plan) {
  if (!plan.touches.empty()) {
    plan.leaving.push_back({plan.touches.size(), std::move(plan.park_via), plan.park_s});
  }
  plan.touches.insert(plan.touches.end(), std::make_move_iterator(there.touches.begin()),
                      std::make_move_iterator(there.touches.end()));
  plan.park_via = std::move(there.park_via);
  plan.park_s = there.park_s;
}

TouchPlan ordered_plan(std::span<const PlanningProblem> places,
                       std::vector<std::vector<PlannedTouch>> touches) {
  TouchPlan plan;
  for (std::size_t place = 0; place < places.size(); ++place) {
    if (touches[place].empty()) continue;
    auto ordered = order_touches(places[place], std::move(touches[place]));
    resize_touches(places[place], plan.touches, ordered);
    auto there = find_paths(places[place], std::move(ordered));
    if (!there) throw std::logic_error("a touch that reaches the park posture has no path to the next one");
    append(std::move(*there), plan);
  }
  return plan;
}

}  // namespace

std::variant<TouchPlan, PlanningFailure> plan_touches(const PlanningProblem& problem,
                                                      const PlanningProgress& progress) {
  return plan_touches(std::span(&problem, 1), progress);
}

std::variant<TouchPlan, PlanningFailure> plan_touches(std::span<const PlanningProblem> places,
                                                      const PlanningProgress& progress) {
  for (const PlanningProblem& place : places) {
    const Chain parked = forward_chain(place.nominal, place.park_joints);
    if (const auto clash = find_clash(travel_scene(place), parked, place.nominal_position_error_m)) {
      return PlanningFailure{
          .kind = PlanningFailure::Kind::kPark,
          .reason = "the " + clash->body + " is too near the " + clash->other + " in the park posture"};
    }
  }
  const PlanningProblem problem = whole_problem(places);
  WholePool pool = find_all_candidates(places, part(progress, 0.0, kPoolShare));
  if (auto failure = find_shortage(problem, pool.efforts)) return std::move(*failure);

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
  TouchPlan plan = ordered_plan(places, complete_touches(places, pool, std::get<TouchChoice>(choice)));
  plan.efforts = std::move(pool.efforts);
  if (progress) progress("ordering the touches", 1.0);
  return plan;
}

}  // namespace calib
