#include "calib_core/planning/online_estimate.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "calib_core/geometry/units.hpp"
#include "calib_core/planning/aimed_touch.hpp"
#include "calib_core/planning/aimed_transfer.hpp"
#include "calib_core/planning/touch_feasibility.hpp"
#include "tests/calib_core/block_study.hpp"

namespace calib {
namespace {

constexpr double kNominalMissMetres = 0.013;  // Table III's, with what a block is put down to
constexpr int kTouchesPerFace = 12;

PlanningProblem paper_problem() {
  PlanningProblem problem{.nominal = paper::nominal(),
                          .joint_ranges = tx90::joint_ranges(),
                          .faces = tx90::faces(),
                          .stylus = {},
                          .scene = tx90::scene(0.0),
                          .park_joints = tx90::park_joints(),
                          .nominal_position_error_m = kNominalMissMetres,
                          .tilt_max_rad = radians_from_degrees(45.0)};
  problem.faces.resize(4);
  problem.knowledge = {.nominal = paper::nominal(),
                       .artefact = exact_artefact(paper::planes()),
                       .touch_noise_m = study::kTouchNoiseMetres};
  return problem;
}

/// An arm with Table III's errors that touches the paper's faces.
class OnlineEstimate : public ::testing::Test {
 protected:
  static std::vector<Touch> touches_of(const KinematicModel& arm) {
    UniformChance chance(7);
    std::vector<Touch> touches;
    for (const study::ExactTouch& exact : study::exact_touches(arm, kTouchesPerFace, chance))
      touches.push_back(exact.touch);
    return touches;
  }

  [[nodiscard]] double position_error_m(const OnlineArmEstimate& estimate, const JointVector& joints) const {
    return (forward_kinematics(estimate.model(), joints).translation() -
            forward_kinematics(truth_, joints).translation())
        .norm();
  }

  /// A touch that the nominal arm can make.
  [[nodiscard]] PlannedTouch planned_touch() const {
    UniformChance chance(3);
    for (int attempt = 0; attempt < 1000; ++attempt) {
      const TouchPose pose = sample_touch_pose(problem_, problem_.faces[2], chance);
      for (const JointVector& joints :
           inverse_kinematics(problem_.nominal, problem_.joint_ranges, pose.block_from_tip)) {
        auto touch = make_touch(problem_, find_target(problem_, 2), pose, joints);
        if (const auto* made = std::get_if<PlannedTouch>(&touch)) return *made;
      }
    }
    throw std::logic_error("no touch can be made");
  }

  const PlanningProblem problem_ = paper_problem();
  const KinematicModel truth_ = apply(paper::nominal(), paper::table3());
  const std::vector<Touch> touches_ = touches_of(truth_);
  const JointVector elsewhere_ = planned_touch().joints;
};

TEST_F(OnlineEstimate, BeforeTheFirstTouchTheNominalArmIsAsGoodAsAnything) {
  const OnlineArmEstimate estimate(problem_);
  EXPECT_EQ(estimate.predicted_position_error_m(elsewhere_), kNominalMissMetres);
  EXPECT_FALSE(estimate.aimed_problem(problem_, std::span(&elsewhere_, 1)));
  const PlannedTouch planned = planned_touch();
  const auto made = aim_touch(problem_, estimate, planned);
  const AimedTouch& touch = std::get<AimedTouch>(made);
  EXPECT_LT((touch.touch.approach_joints - planned.approach_joints).norm(), 1e-9);
  EXPECT_EQ(touch.touch.predicted_position_error_m, kNominalMissMetres);
}

TEST_F(OnlineEstimate, ThePredictionShrinksWithTheTouchesAndTheArmStaysWithinIt) {
  OnlineArmEstimate estimate(problem_);
  double before_m = kNominalMissMetres;
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    const PredictedContact contact = estimate.add(touches_[i]);
    EXPECT_LE(std::abs(contact.position_error_m), contact.predicted_position_error_m) << i;
    EXPECT_FALSE(contact.contradicts) << i;
    const double predicted_m = estimate.predicted_position_error_m(elsewhere_);
    EXPECT_LE(predicted_m, before_m * 1.5) << i;  // a surprise may raise it
    if (predicted_m < kNominalMissMetres) {
      EXPECT_LE(position_error_m(estimate, elsewhere_), predicted_m) << i;
    }
    before_m = predicted_m;
  }
  EXPECT_EQ(before_m, kPredictedPositionErrorMinMetres);
}

TEST_F(OnlineEstimate, AWrongTriggerIsToldAndDoesNotAim) {
  OnlineArmEstimate estimate(problem_);
  for (const Touch& touch : touches_) estimate.add(touch);
  const double before_m = position_error_m(estimate, elsewhere_);
  ContactSurface early = paper::planes()[0];
  early.offset_m += 0.003;
  const PredictedContact contact = estimate.add(moved_onto_plane(truth_, early, touches_[0]));
  EXPECT_TRUE(contact.contradicts);
  EXPECT_NEAR(contact.position_error_m, 0.003, 1e-4);
  EXPECT_NEAR(position_error_m(estimate, elsewhere_), before_m, 1e-5);
  EXPECT_EQ(estimate.predicted_position_error_m(elsewhere_), kPredictedPositionErrorMinMetres)
      << "one says nothing of the arm";
}

TEST_F(OnlineEstimate, AnEarlyWrongTriggerIsFoundOutByTheTouchesThatFollow) {
  OnlineArmEstimate estimate(problem_);
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    ContactSurface plane = paper::planes()[static_cast<std::size_t>(touches_[i].face)];
    plane.offset_m += i == 2 ? 0.003 : 0.0;
    estimate.add(moved_onto_plane(truth_, plane, touches_[i]));
  }
  EXPECT_LT(position_error_m(estimate, elsewhere_), kPredictedPositionErrorMinMetres);
}

TEST_F(OnlineEstimate, ATouchThatIsMadeAgainTakesThePlaceOfTheFirstOne) {
  OnlineArmEstimate estimate(problem_);
  Touch wrong = touches_[1];
  wrong.joints[2] += 0.02;
  for (std::size_t i = 0; i < touches_.size(); ++i) estimate.add(i == 1 ? wrong : touches_[i]);
  EXPECT_EQ(estimate.contradicted(), std::vector<std::size_t>{1});
  EXPECT_FALSE(estimate.replace(1, wrong)) << "it fits no better";
  EXPECT_EQ(estimate.contradicted(), std::vector<std::size_t>{1});
  EXPECT_TRUE(estimate.replace(1, touches_[1]));
  EXPECT_TRUE(estimate.contradicted().empty());
  EXPECT_EQ(estimate.touch_count(), touches_.size());
}

TEST_F(OnlineEstimate, AnArmThatIsPushedMissesByMoreAndSoThePredictionGrows) {
  OnlineArmEstimate estimate(problem_);
  for (const Touch& touch : touches_) estimate.add(touch);
  ErrorVector pushed = paper::table3();
  pushed[error_parameter_index("r0").value()] += 0.004;
  pushed[error_parameter_index("d1").value()] += 0.004;
  const std::vector<Touch> others = touches_of(apply(paper::nominal(), pushed));
  for (std::size_t i = 0; i < 4; ++i) estimate.add(others[i]);
  EXPECT_GT(estimate.predicted_position_error_m(elsewhere_), 3.0 * kPredictedPositionErrorMinMetres);
}

TEST_F(OnlineEstimate, AnAimedTouchBringsTheEstimatedBallToTheSamePointAndSearchesAsFarAsItMayMiss) {
  OnlineArmEstimate estimate(problem_);
  for (const Touch& touch : touches_) estimate.add(touch);
  const PlannedTouch planned = planned_touch();
  const auto made = aim_touch(problem_, estimate, planned);
  const PlannedTouch& touch = std::get<AimedTouch>(made).touch;
  const Eigen::Isometry3d wanted = forward_kinematics(problem_.nominal, planned.joints);
  EXPECT_LT((forward_kinematics(estimate.model(), touch.joints).matrix() - wanted.matrix()).norm(), 1e-8);
  EXPECT_EQ(touch.predicted_position_error_m, kPredictedPositionErrorMinMetres);
  EXPECT_DOUBLE_EQ(touch.search_length_m, 2.0 * kAimedStandoffMinMetres);
  EXPECT_EQ(touch.face, planned.face);
  EXPECT_EQ(touch.role, planned.role);
  const double really_off_m =
      signed_distance_m(problem_.faces[2].plane, forward_kinematics(truth_, touch.joints).translation());
  EXPECT_LT(std::abs(really_off_m), touch.predicted_position_error_m);
}

TEST_F(OnlineEstimate, EveryAimedTouchHasAWayFromTheOneBefore) {
  OnlineArmEstimate estimate(problem_);
  const PlannedTouch planned = planned_touch();
  const auto first = aim_touch(problem_, estimate, planned);
  for (const Touch& touch : touches_) estimate.add(touch);
  const auto second = aim_touch(problem_, estimate, planned);
  const auto way = find_aimed_transfer(problem_, estimate, transfer_end_of(std::get<AimedTouch>(first)),
                                       transfer_end_of(std::get<AimedTouch>(second)));
  ASSERT_TRUE(way);
  EXPECT_LE(way->size(), kAimedTransferPosturesMax);
}

TEST_F(OnlineEstimate, WhatWillBeMissedIsKnownFromThePlanAlone) {
  const PlannedTouch some = planned_touch();
  std::vector<PlannedTouch> planned;
  OnlineArmEstimate estimate(problem_);
  std::vector<double> step_by_step_m;
  for (const Touch& captured : touches_) {
    // The nominal arm on the nominal faces: nothing surprises, only the covariance shrinks.
    const Touch exact = moved_onto_plane(problem_.nominal,
                                         paper::planes()[static_cast<std::size_t>(captured.face)], captured);
    PlannedTouch touch = some;
    touch.face = exact.face;
    touch.joints = exact.joints;
    planned.push_back(touch);
    step_by_step_m.push_back(estimate.predicted_position_error_m(exact.joints));
    estimate.add(exact);
  }
  const std::vector<double> predicted_m = predicted_position_errors_m(problem_, planned);
  ASSERT_EQ(predicted_m.size(), step_by_step_m.size());
  for (std::size_t i = 0; i < step_by_step_m.size(); ++i)
    EXPECT_NEAR(predicted_m[i], step_by_step_m[i], 1e-7) << i;
  EXPECT_EQ(predicted_m.front(), kNominalMissMetres);
  EXPECT_EQ(predicted_m.back(), kPredictedPositionErrorMinMetres);
}

}  // namespace
}  // namespace calib
