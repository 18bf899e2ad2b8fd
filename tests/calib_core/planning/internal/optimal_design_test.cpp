#include "calib_core/planning/internal/optimal_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/kinematics/inverse_kinematics.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "tests/calib_core/drawn_cell.hpp"

namespace calib {
namespace {

constexpr int kFaceCount = 5;
constexpr int kPerFace = 300;
constexpr int kFitCount = 40;
constexpr int kHeldOutCount = 4;
/// The ball is planned to touch; what is identified has gone on by the pre-travel of 10 um.
constexpr double kAlike = 1e-3;

/// The paper's block on its plate, all faces uncertain; 40 touches, from 4 to 12 a face.
PlanningProblem problem_by(PlanCriterion criterion) {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {.radius_m = 0.003},
                          .goal = {.criterion = criterion, .fit_count = kFitCount},
                          .tilt_max_rad = radians_from_degrees(60.0),
                          .knowledge = drawn::problem(drawn::uncertain_artefact(kFaceCount), 20e-6),
                          .workspace_box = {"workspace", {-0.3, -0.5, -0.25}, {0.3, 0.0, 0.55}}};
  problem.identification.identifiability.tried_last = paper::tried_last();
  for (int face = 0; face < kFaceCount; ++face) problem.requests.push_back({face, 4, 12, kHeldOutCount});
  return problem;
}

/// Postures that reach the faces; collisions are not looked at.
const std::vector<TouchCandidate>& candidates() {
  static const std::vector<TouchCandidate> all = [] {
    const PlanningProblem problem = problem_by(PlanCriterion::kTipInBox);
    UniformChance chance(11);
    std::vector<TouchCandidate> made;
    for (int i = 0; std::ssize(made) < kFaceCount * kPerFace; ++i) {
      const int face = i % kFaceCount;
      const TouchPose pose =
          sample_touch_pose(problem, problem.faces[static_cast<std::size_t>(face)], chance);
      const auto postures = inverse_kinematics(problem.nominal, problem.joint_ranges, pose.block_from_tip);
      if (postures.empty()) continue;
      const JointVector& joints = postures[made.size() % postures.size()];
      made.push_back({.face = face, .pose = pose, .joints = joints, .clear_joints = joints});
    }
    return made;
  }();
  return all;
}

TouchChoice chosen(const PlanningProblem& problem) {
  return std::get<TouchChoice>(choose_touches(problem, candidates()));
}

std::vector<Touch> touches_of(const std::vector<std::size_t>& indices) {
  std::vector<Touch> touches;
  for (const std::size_t i : indices) {
    touches.push_back({.face = candidates()[i].face, .joints = candidates()[i].joints});
  }
  return touches;
}

IdentificationResult identified(const PlanningProblem& problem, const std::vector<std::size_t>& fit) {
  IdentificationProblem knowledge = problem.knowledge;
  knowledge.touches = touches_of(fit);
  IdentificationOptions options = problem.identification;
  options.measure_noise = false;  // exact touches have none
  return identify(knowledge, options);
}

std::map<int, int> per_face(const std::vector<std::size_t>& indices) {
  std::map<int, int> counts;
  for (const std::size_t i : indices) ++counts[candidates()[i].face];
  return counts;
}

class TouchChoiceBy : public testing::TestWithParam<PlanCriterion> {};

INSTANTIATE_TEST_SUITE_P(Every, TouchChoiceBy,
                         testing::Values(PlanCriterion::kTipInBox, PlanCriterion::kTipInJointRanges,
                                         PlanCriterion::kInformation, PlanCriterion::kConditionNumber),
                         [](const auto& each) -> std::string {
                           switch (each.param) {
                             case PlanCriterion::kTipInBox:
                               return "TipInBox";
                             case PlanCriterion::kTipInJointRanges:
                               return "TipInJointRanges";
                             case PlanCriterion::kInformation:
                               return "Information";
                             case PlanCriterion::kConditionNumber:
                               break;
                           }
                           return "ConditionNumber";
                         });

TEST_P(TouchChoiceBy, TakesAsManyAsAreAskedForWithinEachFacesBounds) {
  const PlanningProblem problem = problem_by(GetParam());
  const TouchChoice choice = chosen(problem);
  EXPECT_EQ(std::set(choice.fit.begin(), choice.fit.end()).size(), static_cast<std::size_t>(kFitCount));
  const auto counts = per_face(choice.fit);
  for (const TouchRequest& request : problem.requests) {
    EXPECT_GE(counts.at(request.face), request.fit_min);
    EXPECT_LE(counts.at(request.face), request.fit_max);
  }
}

TEST_P(TouchChoiceBy, HoldsOutOthersOnEveryFace) {
  const TouchChoice choice = chosen(problem_by(GetParam()));
  std::set<std::size_t> all(choice.fit.begin(), choice.fit.end());
  all.insert(choice.held_out.begin(), choice.held_out.end());
  EXPECT_EQ(all.size(), choice.fit.size() + choice.held_out.size());
  for (const auto& [face, count] : per_face(choice.held_out)) EXPECT_EQ(count, kHeldOutCount) << face;
  EXPECT_EQ(choice.held_out.size(), static_cast<std::size_t>(kFaceCount * kHeldOutCount));
}

TEST_P(TouchChoiceBy, IsTheSameForTheSameProblem) {
  EXPECT_EQ(chosen(problem_by(GetParam())).fit, chosen(problem_by(GetParam())).fit);
}

TEST_P(TouchChoiceBy, ExpectsTheFiguresThatIdentifyGivesOfTheSameTouches) {
  const PlanningProblem problem = problem_by(GetParam());
  const TouchChoice choice = chosen(problem);
  const ExpectedFigures expected = expected_figures(problem, touches_of(choice.fit));
  const IdentificationResult result = identified(problem, choice.fit);
  ASSERT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
  const ArmMatrix covariance = result.uncertainty->covariance();
  EXPECT_TRUE(expected.uncertainty.covariance().isApprox(covariance, kAlike));
  EXPECT_NEAR(expected.condition_number, result.iterations.back().condition_number,
              kAlike * expected.condition_number);
  const TipRegion region =
      GetParam() == PlanCriterion::kTipInJointRanges
          ? region_over_joint_ranges(problem.nominal, problem.joint_ranges)
          : region_over_box(problem.nominal, problem.joint_ranges, problem.workspace_box);
  EXPECT_NEAR(choice.tip_rms_m.value(), region.rms_m(covariance).value(), kAlike * choice.tip_rms_m.value());
}

struct Figures {
  double tip_in_box_m = 0.0;
  double tip_in_joint_ranges_m = 0.0;
  double log_determinant = 0.0;
  double condition_number = 0.0;
};

Figures figures_by(PlanCriterion criterion) {
  const PlanningProblem problem = problem_by(criterion);
  const IdentificationResult result = identified(problem, chosen(problem).fit);
  const ArmMatrix covariance = result.uncertainty->covariance();
  Figures figures{
      .tip_in_box_m = region_over_box(problem.nominal, problem.joint_ranges, problem.workspace_box)
                          .rms_m(covariance)
                          .value(),
      .tip_in_joint_ranges_m =
          region_over_joint_ranges(problem.nominal, problem.joint_ranges).rms_m(covariance).value(),
      .condition_number = result.iterations.back().condition_number};
  for (const double sigma : result.singular_values) figures.log_determinant += 2.0 * std::log(sigma);
  return figures;
}

TEST(TouchChoice, IsTheBestOfAllByItsOwnCriterion) {
  // Exchange ends in a local optimum, and the two tip errors are close relatives.
  constexpr double kLocalOptimum = 1.01;
  const Figures box = figures_by(PlanCriterion::kTipInBox);
  const Figures ranges = figures_by(PlanCriterion::kTipInJointRanges);
  const Figures information = figures_by(PlanCriterion::kInformation);
  const Figures condition = figures_by(PlanCriterion::kConditionNumber);
  for (const Figures& other : {ranges, information, condition}) {
    EXPECT_LT(box.tip_in_box_m, kLocalOptimum * other.tip_in_box_m);
  }
  for (const Figures& other : {box, information, condition}) {
    EXPECT_LT(ranges.tip_in_joint_ranges_m, kLocalOptimum * other.tip_in_joint_ranges_m);
  }
  for (const Figures& other : {box, ranges, condition}) {
    EXPECT_GT(information.log_determinant, other.log_determinant);
  }
  for (const Figures& other : {box, ranges, information}) {
    EXPECT_LT(condition.condition_number, other.condition_number);
  }
}

/// The same cell with an arm that carries its weight on joints 2 and 3 and yields there by an unknown amount.
PlanningProblem yielding_problem() {
  PlanningProblem problem = problem_by(PlanCriterion::kTipInBox);
  for (KinematicModel* model : {&problem.nominal, &problem.knowledge.nominal}) {
    model->masses[3] = {30.0, {0.2, 0.0, 0.1}};
    model->masses[6] = {10.0, {0.0, 0.0, 0.1}};
  }
  for (const int joint : {1, 2})
    problem.knowledge.nongeometric_std[static_cast<std::size_t>(compliance_position(joint))] = 3e-6;
  problem.identification.stiffness = true;
  return problem;
}

TEST(TouchChoice, ShowsTheComplianceBetterWhereItIsEstimated) {
  const PlanningProblem problem = yielding_problem();
  const std::vector<std::size_t> with = chosen(problem).fit;
  const std::vector<std::size_t> rigid = chosen(problem_by(PlanCriterion::kTipInBox)).fit;
  EXPECT_NE(std::set(with.begin(), with.end()), std::set(rigid.begin(), rigid.end()));
  const auto deviation = [&](const std::vector<std::size_t>& fit, int joint) {
    const IdentificationResult result = identified(problem, fit);
    EXPECT_EQ(result.status, IdentificationStatus::kConverged) << result.message;
    return result.uncertainty->std_error(nongeometric_index(compliance_position(joint)));
  };
  for (const int joint : {1, 2}) EXPECT_LT(deviation(with, joint), deviation(rigid, joint)) << joint;
}

TEST(TouchChoice, TakesTheFewestThatReachAWantedAccuracy) {
  PlanningProblem problem = problem_by(PlanCriterion::kTipInBox);
  problem.goal.fit_count = 30;
  const double wanted_m = chosen(problem).tip_rms_m.value();
  problem.goal = {.criterion = PlanCriterion::kTipInBox, .fit_count = 60, .tip_rms_max_m = wanted_m};
  const TouchChoice choice = chosen(problem);
  EXPECT_LE(choice.tip_rms_m.value(), wanted_m);
  EXPECT_LE(choice.fit.size(), 31u);  // one more where exchange ends in another place
  const auto counts = per_face(choice.fit);
  for (const TouchRequest& request : problem.requests) EXPECT_GE(counts.at(request.face), request.fit_min);
  problem.goal.tip_rms_max_m.reset();
  problem.goal.fit_count = static_cast<int>(choice.fit.size()) - 2;
  EXPECT_GT(chosen(problem).tip_rms_m.value(), wanted_m);
}

TEST(TouchChoice, TellsTheBestThatCanBeHadWhenAnAccuracyCannot) {
  PlanningProblem problem = problem_by(PlanCriterion::kTipInJointRanges);
  const double best_m = chosen(problem).tip_rms_m.value();
  problem.goal.tip_rms_max_m = 0.5 * best_m;
  const auto answer = choose_touches(problem, candidates());
  const auto* failure = std::get_if<ChoiceFailure>(&answer);
  ASSERT_NE(failure, nullptr);
  EXPECT_DOUBLE_EQ(failure->best_tip_rms_m.value(), best_m);
  EXPECT_THAT(failure->reason,
              testing::MatchesRegex("40 touches leave 0\\.[0-9]+ mm rms over the joint ranges, "
                                    "most of it from touch_noise \\(0\\.[0-9]+ mm\\)"));
}

TEST(TouchChoice, RefusesABoxOutOfReach) {
  PlanningProblem problem = problem_by(PlanCriterion::kTipInBox);
  problem.workspace_box = {"far", {5.0, 5.0, 5.0}, {6.0, 6.0, 6.0}};
  const auto answer = choose_touches(problem, candidates());
  const auto* failure = std::get_if<ChoiceFailure>(&answer);
  ASSERT_NE(failure, nullptr);
  EXPECT_EQ(failure->best_tip_rms_m, std::nullopt);
  problem.goal.criterion = PlanCriterion::kConditionNumber;  // which asks nothing of the box
  EXPECT_EQ(chosen(problem).tip_rms_m, std::nullopt);
}

TEST(TouchChoice, TellsThatOnePlaneCannotShowAll) {
  PlanningProblem problem = problem_by(PlanCriterion::kTipInBox);
  for (TouchRequest& request : problem.requests)
    request.fit_max = request.face == 0 ? problem.goal.fit_count : 0;
  for (TouchRequest& request : problem.requests) request.fit_min = 0;
  const auto answer = choose_touches(problem, candidates());
  const auto* failure = std::get_if<ChoiceFailure>(&answer);
  ASSERT_NE(failure, nullptr);
  EXPECT_EQ(failure->kind, ChoiceFailure::Kind::kUnidentifiable);
}

TEST(TouchChoice, RefusesAFaceWithFewerCandidatesThanItNeeds) {
  PlanningProblem problem = problem_by(PlanCriterion::kTipInBox);
  const auto there = std::ranges::count(candidates(), 2, &TouchCandidate::face);
  problem.requests[2].fit_min = problem.requests[2].fit_max = static_cast<int>(there);
  EXPECT_THROW(choose_touches(problem, candidates()), std::logic_error);
}

}  // namespace
}  // namespace calib
