#include "service/documents/plan.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/proof/detection_planning.hpp"
#include "calib_core/qualification/qualification_planning.hpp"
#include "config/identification_problem.hpp"
#include "config/place_cell.hpp"
#include "config/touched_places.hpp"
#include "service/base/digest.hpp"
#include "service/documents/internal/plan_view.hpp"
#include "service/run/planning_problem.hpp"

namespace cell {
namespace {

using calib::mm_from_metres;

/// Hexadecimal digits of an id.
constexpr std::size_t kIdDigits = 16;

/// Postures sampled to estimate how near the tip comes to an unreachable target.
constexpr int kReachPostures = 20'000;

/// Number of obstructions reported for a face, the most frequent ones.
constexpr std::size_t kObstructionsReported = 3;

/// Smallest distance of the nominal tip from a box, or from a point if both corners are equal. Metres.
double nearest_tip_m(const Arm& arm, const Eigen::Vector3d& min_m, const Eigen::Vector3d& max_m) {
  const calib::PreparedModel model = calib::prepare(arm.model);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (int i = 1; i <= kReachPostures; ++i) {
    const auto chain = calib::forward_chain(model, calib::halton_posture(i, arm.joint_ranges));
    const Eigen::Vector3d tip_m = chain.tip_in_block_m();
    nearest_m = std::min(nearest_m, (tip_m - tip_m.cwiseMax(min_m).cwiseMin(max_m)).norm());
  }
  return nearest_m;
}

PlanRefusal refuse_workspace_box(const Cell& cell) {
  const calib::Box& box = cell.workspace_box;
  return {
      .kind = PlanRefusal::Kind::kWorkspaceBox,
      .message = fmt::format(
          "the workspace box \"{}\" is out of the arm's range: none of {} postures in the joint ranges has "
          "the tip in it, the nearest is {:.0f} mm off; move the box (\"workspace_box\" in the cell's file)",
          box.name, kReachPostures, mm_from_metres(nearest_tip_m(cell.arm, box.min_m, box.max_m)))};
}

const calib::FaceEffort* effort_of(const calib::PlanningFailure& failure) {
  const auto found = std::ranges::find(failure.efforts, failure.face, &calib::FaceEffort::face);
  return found == failure.efforts.end() ? nullptr : &*found;
}

/// Refusal for a face with too few touches: out of reach, or in reach and always obstructed.
PlanRefusal refuse_face(const Cell& cell, const Recipe& recipe, const calib::PlanningFailure& failure) {
  const Eigen::Vector3d& center_m = face_of_block(cell.block, failure.face).center_m;
  const Cell there = cell_at_place(cell, recipe, place_of_face(cell.block, recipe, failure.face));
  const double nearest_mm = mm_from_metres(nearest_tip_m(there.arm, center_m, center_m));
  const auto place = further_place_name(cell.block, recipe, failure.face);
  const auto tip = further_tip_name(cell, recipe, failure.face);
  const calib::FaceEffort* effort = effort_of(failure);
  // Too few on this plane itself, or too few in total with the fewest on this plane.
  const bool over_all = effort && effort->feasible != failure.found;
  std::string message = fmt::format("plane {}{}{}: {} of {} touches {}can be made", failure.face + 1,
                                    place ? fmt::format(" at \"{}\"", *place) : "",
                                    tip ? fmt::format(" with the tip \"{}\"", *tip) : "", failure.found,
                                    failure.wanted, over_all ? "over all planes " : "");
  if (effort) message += fmt::format(", after {} postures tried", effort->tried);
  message +=
      fmt::format("; most frequent obstruction: {}; the tip comes as near as {:.0f} mm to the plane's centre",
                  failure.reason, nearest_mm);
  message += failure.found > 0 ? "; ask for fewer touches, or move the block (touchcal plan --place)"
                               : "; move the block (touchcal plan --place), or leave the plane out";
  return {.kind = PlanRefusal::Kind::kFace, .message = message, .efforts = failure.efforts};
}

PlanRefusal refuse(const Cell& cell, const Recipe& recipe, const calib::PlanningFailure& failure) {
  switch (failure.kind) {
    case calib::PlanningFailure::Kind::kPark:
      return {.kind = PlanRefusal::Kind::kPark,
              .message = failure.reason + "; choose other park_joints_deg in the cell's file"};
    case calib::PlanningFailure::Kind::kAccuracy:
      return {.kind = PlanRefusal::Kind::kAccuracy,
              .message = fmt::format(
                  "a predicted tip error of {:.4g} mm is not attainable{}: {}; allow more touches (--fit) to "
                  "reduce "
                  "touch_noise, give better figures of block and probe to reduce the rest",
                  mm_from_metres(recipe.goal.tip_rms_max_m.value_or(0.0)),
                  failure.best_tip_rms_m
                      ? fmt::format(", the best is {:.4g} mm", mm_from_metres(*failure.best_tip_rms_m))
                      : std::string(),
                  failure.reason),
              .efforts = failure.efforts};
    case calib::PlanningFailure::Kind::kUnidentifiable:
      return {.kind = PlanRefusal::Kind::kTouches,
              .message = failure.reason +
                         "; touch more planes, or exclude the parameters that these planes do not determine",
              .efforts = failure.efforts};
    case calib::PlanningFailure::Kind::kFace:
      break;
  }
  return refuse_face(cell, recipe, failure);
}

PlanRefusal refuse_proof_of_nothing(const Cell& cell) {
  return {.kind = PlanRefusal::Kind::kAccuracy,
          .message = fmt::format(
              "a proof is planned for what the model of the arm '{}' may lack, and nothing is known of that: "
              "give its compliance and its gears deviations (\"gravity\", \"gears\" of the arm's file)",
              cell.arm.name),
          .efforts = {}};
}

/// Sets document and id of a plan.
void name_plan(PlanDocument document, Plan& plan) {
  plan.id = sha256_hex(document_text(document)).substr(0, kIdDigits);
  document.plan_id = plan.id;
  plan.document = document_text(document);
}

/// Refuses fewer touches than parameters, of which the ball of each further tip is three; with a prior any
/// number will do.
std::optional<PlanRefusal> refuse_too_few(const Recipe& recipe, const calib::PlanningProblem& problem) {
  const int of_balls = 3 * static_cast<int>(problem.tips.size());
  const int needed = problem.knowledge.attainable.value().count + of_balls;
  if (recipe.identification.prior || problem.goal.fit_count >= needed) return std::nullopt;
  return PlanRefusal{
      .kind = PlanRefusal::Kind::kTouches,
      .message = fmt::format("{} touches to fit, but {} parameters need at least {}: {} more are missing",
                             problem.goal.fit_count, needed, needed, needed - problem.goal.fit_count),
      .efforts = {}};
}

}  // namespace

PlannedIdentification identify_planned(const Cell& cell, const Recipe& recipe, const calib::TouchPlan& plan) {
  PlannedIdentification planned_run{.problem = identification_problem(cell, recipe), .result = {}};
  calib::IdentificationProblem& problem = planned_run.problem;
  const calib::PreparedModel nominal = calib::prepare(problem.nominal);
  for (const calib::PlannedTouch& planned : plan.touches) {
    // Temperature and pre-travel displace the trigger slightly from the nominal face.
    const calib::ContactSurface& contact =
        problem.artefact.contact_planes[static_cast<std::size_t>(planned.face)];
    problem.touches.push_back(
        calib::moved_onto_plane(nominal, contact, {planned.face, planned.joints, planned.role}));
  }
  calib::IdentificationOptions options = recipe.identification;
  options.robust = false;         // there is nothing to leave out
  options.measure_noise = false;  // touches of the nominal arm have none: the declared one is promised
  planned_run.result = calib::identify(problem, options);
  return planned_run;
}

std::variant<Plan, PlanRefusal> make_plan(const TipRegions& regions, const Recipe& recipe,
                                          const calib::PlanningProgress& progress) {
  const Cell& cell = regions.cell();
  if (regions.tip().workspace_box.posture_count == 0) return refuse_workspace_box(cell);
  const std::vector<calib::PlanningProblem> problems = planning_problems(cell, recipe);
  if (auto refusal = refuse_too_few(recipe, problems.front())) return std::move(*refusal);
  auto outcome = calib::plan_touches(problems, progress);
  if (const auto* failure = std::get_if<calib::PlanningFailure>(&outcome))
    return refuse(cell, recipe, *failure);
  Plan plan{.recipe = recipe.name, .touches = std::get<calib::TouchPlan>(std::move(outcome))};
  const PlannedIdentification planned = identify_planned(cell, recipe, plan.touches);
  if (planned.result.status != calib::IdentificationStatus::kConverged) {
    return PlanRefusal{
        .kind = PlanRefusal::Kind::kTouches,
        .message = fmt::format("the planned touches are not sufficient: {}", planned.result.message),
        .efforts = plan.touches.efforts};
  }
  name_plan(plan_of(regions, recipe, plan.touches, planned), plan);
  return plan;
}

namespace {

PlanRefusal refuse_qualification(const calib::PlanningFailure& failure) {
  return {.kind = PlanRefusal::Kind::kFace,
          .message = fmt::format("the stylus can be turned to {} of {} directions at one place at best, on "
                                 "plane {}: {}; move the block, let the stylus lean farther "
                                 "(stylus_tilt_max_deg), or use a stylus on the axis of joint 6",
                                 failure.found, failure.wanted, failure.face + 1, failure.reason),
          .efforts = failure.efforts};
}

std::variant<Plan, PlanRefusal> plan_made(const Cell& cell, const Recipe& recipe, RunKind kind,
                                          std::variant<calib::TouchPlan, calib::PlanningFailure> outcome) {
  if (const auto* failure = std::get_if<calib::PlanningFailure>(&outcome))
    return refuse(cell, recipe, *failure);
  Plan plan{.recipe = recipe.name, .touches = std::get<calib::TouchPlan>(std::move(outcome))};
  name_plan(plan_of_verification(cell, recipe, plan.touches, kind), plan);
  return plan;
}

std::variant<Plan, PlanRefusal> make_qualification_plan(const Cell& cell, const Recipe& recipe,
                                                        calib::PlanningProblem problem) {
  problem.candidate_count = calib::kQualifyingCandidates;
  auto outcome = calib::plan_qualification(problem, cell.block.lengths);
  const auto* failure = std::get_if<calib::PlanningFailure>(&outcome);
  if (failure && failure->kind == calib::PlanningFailure::Kind::kFace) return refuse_qualification(*failure);
  return plan_made(cell, recipe, RunKind::kQualification, std::move(outcome));
}

}  // namespace

std::variant<Plan, PlanRefusal> make_verification_plan(const TipRegions& regions, const Recipe& recipe,
                                                       const Verification& verification) {
  const Cell& cell = regions.cell();
  calib::PlanningProblem problem = planning_problem(cell, recipe);
  if (verification.kind == RunKind::kQualification) return make_qualification_plan(cell, recipe, problem);
  problem.candidate_count = calib::kDetectionCandidates;
  if (verification.kind == RunKind::kTool)
    return plan_made(cell, recipe, RunKind::kTool,
                     calib::plan_tool(problem, *verification.record, verification.tip));
  const bool is_proof = verification.kind == RunKind::kProof;
  std::vector<calib::ProofAlternative> alternatives;
  if (is_proof) alternatives = calib::proof_alternatives(*verification.record, regions.tip().workspace_box);
  if (is_proof && alternatives.empty()) return refuse_proof_of_nothing(cell);
  auto outcome = is_proof ? calib::plan_proof(problem, *verification.record, verification.place, alternatives)
                          : calib::plan_check(problem, *verification.record);
  return plan_made(cell, recipe, verification.kind, std::move(outcome));
}

std::vector<std::string> effort_lines(const std::vector<calib::FaceEffort>& efforts) {
  std::vector<std::string> lines;
  for (const calib::FaceEffort& effort : efforts) {
    std::string line = fmt::format("plane {}: {} of {} postures tried can be touched", effort.face + 1,
                                   effort.feasible, effort.tried);
    for (std::size_t i = 0; i < std::min(effort.obstructions.size(), kObstructionsReported); ++i) {
      const calib::Obstruction& obstruction = effort.obstructions[i];
      line +=
          fmt::format("{} {} ({})", i == 0 ? "; obstructed by:" : ",", obstruction.reason, obstruction.count);
    }
    lines.push_back(line);
  }
  return lines;
}

}  // namespace cell
