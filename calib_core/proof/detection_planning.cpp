#include "calib_core/proof/detection_planning.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "calib_core/planning/touch_order.hpp"
#include "calib_core/proof/check.hpp"
#include "calib_core/proof/check_effects.hpp"
#include "calib_core/proof/detection_design.hpp"
#include "calib_core/proof/internal/column_space.hpp"
#include "calib_core/proof/touch_rows.hpp"

namespace calib {
namespace {

/// The touches of a proof tell of the block's pose, in the direction that they tell least of, this share of
/// what an average choice tells: less, and what noise makes of the pose is more than a touch is taken for one
/// of this block (kProofFarMetres).
constexpr double kPoseShareMin = 0.1;

std::vector<Touch> touches_of(std::span<const TouchCandidate> candidates) {
  std::vector<Touch> touches;
  for (const TouchCandidate& candidate : candidates)
    touches.push_back({.face = candidate.face, .joints = candidate.joints, .role = TouchRole::kProof});
  return touches;
}

PlannedTouch whole_touch(const PlanningProblem& problem, const TouchCandidate& candidate) {
  auto made = make_touch(problem, find_target(problem, candidate.face), candidate.pose, candidate.joints);
  if (const auto* reason = std::get_if<std::string>(&made))
    throw std::logic_error("a candidate is infeasible: " + *reason);
  PlannedTouch& touch = std::get<PlannedTouch>(made);
  touch.role = TouchRole::kProof;
  touch.predicted_position_error_m = problem.nominal_position_error_m;
  return std::move(touch);
}

/// `design` makes the questions of these touches.
template <class Design>
std::variant<TouchPlan, PlanningFailure> plan(const PlanningProblem& problem, int count,
                                              const Design& design) {
  CandidatePool pool = find_candidates(problem);
  const auto found = static_cast<int>(pool.candidates.size());
  if (found < count) {
    const auto scarcest = std::ranges::min_element(pool.efforts, {}, &FaceEffort::feasible);
    const bool is_explained = scarcest != pool.efforts.end() && !scarcest->obstructions.empty();
    return PlanningFailure{
        .kind = PlanningFailure::Kind::kFace,
        .face = scarcest == pool.efforts.end() ? 0 : scarcest->face,
        .found = found,
        .wanted = count,
        .reason = is_explained ? scarcest->obstructions.front().reason : "no posture was tried",
        .efforts = std::move(pool.efforts)};
  }
  const DetectionProblem detection = design(touches_of(pool.candidates));
  std::vector<PlannedTouch> touches;
  for (const std::size_t index : choose_for_detection(detection, static_cast<std::size_t>(count)))
    touches.push_back(whole_touch(problem, pool.candidates[index]));
  auto made = find_paths(problem, order_touches(problem, std::move(touches)));
  if (!made) throw std::logic_error("a touch that reaches the park posture has no path to the next one");
  made->efforts = std::move(pool.efforts);
  return std::move(*made);
}

}  // namespace

std::variant<TouchPlan, PlanningFailure> plan_proof(const PlanningProblem& there,
                                                    const CalibrationRecord& record, const ProofPlace& place,
                                                    std::span<const ProofAlternative> alternatives) {
  if (alternatives.empty()) throw std::logic_error("a proof is planned against one alternative or more");
  return plan(there, kProofTouchCount, [&](const std::vector<Touch>& touches) {
    const TouchRows rows =
        touch_rows(record, arm_at(record.calibrated(), place.calibrated_from_block), touches);
    DetectionProblem problem{.seed = there.seed};
    problem.covariance = proof_covariance(record, place, rows, touches);
    DetectionQuestion question{.directions = FaultDirections::kAny,
                               .free = column_space(rows.of_place),
                               .free_share_min = kPoseShareMin};
    for (const ProofAlternative& alternative : alternatives)
      question.faults.emplace_back(rows.of_unknowns * alternative.displacements);
    problem.questions.push_back(std::move(question));
    return problem;
  });
}

std::variant<TouchPlan, PlanningFailure> plan_check(const PlanningProblem& here,
                                                    const CalibrationRecord& record) {
  return plan(here, kCheckTouchCount, [&](const std::vector<Touch>& touches) {
    const CheckEffects effects = check_effects(record, touch_rows(record, record.calibrated(), touches));
    const auto count = std::ssize(touches);
    DetectionProblem problem{.seed = here.seed};
    problem.covariance = std::pow(record.noise().std_m, 2) * Eigen::MatrixXd::Identity(count, count);
    const Eigen::MatrixXd offsets = kCheckOffsetRadians * effects.of_joints;
    for (const Eigen::MatrixXd& other : {Eigen::MatrixXd(count, 0), effects.of_stylus, effects.of_block}) {
      DetectionQuestion question{.faults = {offsets}, .free = Eigen::MatrixXd(count, 1 + other.cols())};
      question.free << effects.of_growth, other;
      problem.questions.push_back(std::move(question));
    }
    return problem;
  });
}

std::variant<TouchPlan, PlanningFailure> plan_tool(const PlanningProblem& here,
                                                   const CalibrationRecord& record, const ToolTip& tip) {
  return plan(here, kToolTouchCount, [&](const std::vector<Touch>& touches) {
    const ToolRows rows = tool_rows(record, tip, tip.drawn_m, touches);
    DetectionQuestion question{.faults = {kToolDrawnWithinMetres * Eigen::MatrixXd(rows.of_centre)},
                               .free = Eigen::MatrixXd(std::ssize(touches), 0)};
    return DetectionProblem{.covariance = tool_covariance(record, tip, rows, touches),
                            .questions = {std::move(question)},
                            .seed = here.seed};
  });
}

}  // namespace calib
