#include "service/run/tip_prediction.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "config/identification_problem.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

/// A region where the first error alone moves the tip, by so much a unit.
calib::TipRegion moved_by_the_first(double metres_a_unit) {
  calib::TipRegion region{.posture_count = 1};
  region.mean_square(0, 0) = metres_a_unit * metres_a_unit;
  return region;
}

calib::UncertaintyBudget certainty_with(const std::vector<calib::ArmVector>& unknown_directions) {
  calib::UncertaintyBudget uncertainty;
  uncertainty.identified(0, 0) = 4e-8;
  uncertainty.unseen(0, 0) = 5e-8;
  uncertainty.unseen_without_tolerance.resize(unknown_directions.size());
  uncertainty.unknown_directions.resize(calib::kArmParameterCount,
                                        static_cast<Eigen::Index>(unknown_directions.size()));
  for (std::size_t i = 0; i < unknown_directions.size(); ++i)
    uncertainty.unknown_directions.col(static_cast<Eigen::Index>(i)) = unknown_directions[i];
  return uncertainty;
}

TEST(PredictedRms, CountsWhatIsIdentifiedAndWhatIsUnseen) {
  EXPECT_NEAR(predicted_rms_m(moved_by_the_first(0.5), certainty_with({})).value(), 0.5 * 3e-4, 1e-15);
}

TEST(PredictedRms, IsUnknownWhereAnErrorOfUnknownSizeMovesTheTip) {
  const calib::UncertaintyBudget uncertainty =
      certainty_with({calib::ArmVector::Unit(1), calib::ArmVector::Unit(0)});
  EXPECT_EQ(predicted_rms_m(moved_by_the_first(1.01 * kUnknownMattersMetres), uncertainty), std::nullopt);
  EXPECT_TRUE(predicted_rms_m(moved_by_the_first(0.99 * kUnknownMattersMetres), uncertainty).has_value());
}

TEST(PredictedRms, IsUnknownWhereTheArmHasNoPosture) {
  EXPECT_EQ(predicted_rms_m({}, certainty_with({})), std::nullopt);
}

class TipPredictionTest : public ::testing::Test {
 protected:
  TipPredictionTest() {
    problem_ = identification_problem(edf(), recipe_);
    problem_.touches = table3_touches();
    problem_.nongeometric_std = {};  // only kinematic errors
  }
  TipPrediction predict(const Cell& cell) {
    const TipRegions regions(cell);
    return predict_tip(regions, problem_, calib::identify(problem_, recipe_.identification));
  }

  const Recipe& recipe_ = edf().recipes.at("edf-25");
  calib::IdentificationProblem problem_;
};

TEST_F(TipPredictionTest, AToolOfAnotherLengthIsAsUncertainAsTheTouchesLeaveItsDirection) {
  Cell cell = edf();
  Eigen::Isometry3d gripper = Eigen::Isometry3d::Identity();
  gripper.translate(Eigen::Vector3d(0.2, 0.0, 0.2));
  cell.tools = {{"gripper", gripper}};
  const TipPrediction prediction = predict(cell);
  ASSERT_EQ(prediction.tools.size(), 1u);
  EXPECT_EQ(prediction.tools[0].name, "gripper");
  // The joint 6 direction is unseen by a stylus on its axis: 0.2 m off the axis its tolerance is met.
  EXPECT_GT(prediction.tools[0].joint_ranges_rms_m.value(), 2.0 * prediction.joint_ranges_rms_m.value());
}

TEST_F(TipPredictionTest, WithoutTolerancesOfTheUnseenErrorsTheToolIsUnknownAndTheTipIsNot) {
  Cell cell = edf();
  Eigen::Isometry3d gripper = Eigen::Isometry3d::Identity();
  gripper.translate(Eigen::Vector3d(0.2, 0.0, 0.2));
  cell.tools = {{"gripper", gripper}};
  problem_.tolerances.fill(std::nullopt);
  const TipPrediction prediction = predict(cell);
  EXPECT_TRUE(prediction.at_block_rms_m.has_value());
  EXPECT_TRUE(prediction.workspace_box_rms_m.has_value());
  EXPECT_TRUE(prediction.joint_ranges_rms_m.has_value());
  EXPECT_EQ(prediction.tools.at(0).joint_ranges_rms_m, std::nullopt);
}

TEST_F(TipPredictionTest, AtTheBlockTheTipIsBetterKnownThanElsewhere) {
  const TipPrediction prediction = predict(edf());
  EXPECT_LT(prediction.at_block_rms_m.value(), prediction.joint_ranges_rms_m.value());
}

// Neither is ever estimated by itself: what the maker says of them is all that anybody knows.
TEST_F(TipPredictionTest, NamesTheComplianceOfTheWristAndThePlayOfTheGearsAmongItsSources) {
  const auto box_rms_m = [&](const char* name) {
    for (const auto& source : predict(edf()).sources)
      if (source.name == name) return source.workspace_box_rms_m.value();
    return 0.0;
  };
  problem_.gear_lag_std_rad.setZero();
  EXPECT_EQ(box_rms_m("compliance"), 0.0);
  EXPECT_EQ(box_rms_m("backlash"), 0.0);
  for (const int joint : {3, 4}) {  // on the axis of joint 6 nothing hangs
    problem_.nongeometric_std = {};
    problem_.nongeometric_std[static_cast<std::size_t>(calib::compliance_position(joint))] = 5e-6;
    EXPECT_GT(box_rms_m("compliance"), 1e-7) << joint + 1;
  }
  problem_.gear_lag_std_rad = edf().arm.gears.lag_std_rad();
  EXPECT_GT(box_rms_m("backlash"), 1e-6);
}

TEST_F(TipPredictionTest, AWarmerArmIsOffByWhatItHasGrown) {
  Cell cell = edf();
  cell.arm.growth.reset();
  EXPECT_FALSE(predict(cell).warmer);
  constexpr double kExpansionPerK = 2.3e-5, kRiseK = 8.0;
  cell.arm.growth = Growth{.expansion_per_k = kExpansionPerK, .rise_k = kRiseK};
  const TipPrediction prediction = predict(cell);
  // The tips of a grown arm, frame by frame, against those of the arm.
  calib::KinematicModel grown = cell.arm.model;
  for (std::size_t frame = 2; frame < calib::kFrameCount - 1; ++frame) {
    grown.links[frame].d_m *= 1.0 + kExpansionPerK * kRiseK;
    grown.links[frame].r_m *= 1.0 + kExpansionPerK * kRiseK;
  }
  const auto postures = calib::postures_in_box(cell.arm.model, cell.arm.joint_ranges, cell.workspace_box);
  double sum = 0.0;
  for (const calib::JointVector& joints : postures)
    sum += (forward_chain(prepare(grown), joints).tip_in_block_m() -
            forward_chain(prepare(cell.arm.model), joints).tip_in_block_m())
               .squaredNorm();
  const double by_growth_m = std::sqrt(sum / static_cast<double>(postures.size()));
  EXPECT_NEAR(prediction.warmer.value().workspace_box_rms_m.value(),
              std::hypot(prediction.workspace_box_rms_m.value(), by_growth_m), 1e-6);
  EXPECT_GT(by_growth_m, 5e-5) << "else it would not matter";
}

TEST_F(TipPredictionTest, WhatOneComputedOfACellAnotherNeedsNotComputeAgain) {
  const TipRegions regions(edf());
  const TipRegions other(edf(), regions.shared());
  EXPECT_EQ(&other.map(), &regions.map());
  EXPECT_EQ(&other.tip(), &regions.tip());
  EXPECT_EQ(&other.tools(), &regions.tools());
  EXPECT_NE(&TipRegions(edf()).map(), &regions.map());
}

TEST_F(TipPredictionTest, InTheArmsOwnFrameTheBlocksPlaceDoesNotCount) {
  calib::IdentificationResult result = calib::identify(problem_, recipe_.identification);
  const TipRegions regions(edf());
  const auto only = [&](bool is_place) {
    calib::ArmCovariance& identified = result.uncertainty->identified;
    identified.setZero();
    result.uncertainty->held.setZero();
    result.uncertainty->unseen.setZero();
    result.uncertainty->of_posture.setZero();
    for (int i = 0; i < calib::kErrorParameterCount; ++i)
      identified(i, i) = calib::is_place_error(i) == is_place ? 1e-8 : 0.0;
    return predict_tip(regions, problem_, result);
  };
  const TipPrediction of_place = only(true);
  EXPECT_GT(of_place.expanded.box_max_m.value(), 1e-4);
  EXPECT_EQ(of_place.arm_frame.at_block_rms_m, 0.0);
  EXPECT_EQ(of_place.arm_frame.workspace_box_rms_m, 0.0);
  EXPECT_EQ(of_place.arm_frame.joint_ranges_rms_m, 0.0);
  EXPECT_EQ(of_place.arm_frame.expanded.box_rms_m, 0.0);
  EXPECT_EQ(of_place.arm_frame.expanded.box_p95_m, 0.0);
  EXPECT_EQ(of_place.arm_frame.expanded.box_max_m, 0.0);

  const TipPrediction of_arm = only(false);
  EXPECT_EQ(of_arm.arm_frame.at_block_rms_m, of_arm.at_block_rms_m);
  EXPECT_EQ(of_arm.arm_frame.workspace_box_rms_m, of_arm.workspace_box_rms_m);
  EXPECT_EQ(of_arm.arm_frame.joint_ranges_rms_m, of_arm.joint_ranges_rms_m);
  EXPECT_EQ(of_arm.arm_frame.expanded.box_rms_m, of_arm.expanded.box_rms_m);
  EXPECT_EQ(of_arm.arm_frame.expanded.box_p95_m, of_arm.expanded.box_p95_m);
  EXPECT_EQ(of_arm.arm_frame.expanded.box_max_m, of_arm.expanded.box_max_m);
}

TEST_F(TipPredictionTest, TheExpandedUncertaintyIsKTimesTheStandardOneOverTheBox) {
  const TipPrediction tip = predict(edf());
  const double rms_m = tip.expanded.box_rms_m.value();
  EXPECT_NEAR(rms_m / tip.workspace_box_rms_m.value(), calib::kTipCoverageFactor, 1e-9);
  EXPECT_LE(rms_m, tip.expanded.box_p95_m.value());
  EXPECT_LE(tip.expanded.box_p95_m.value(), tip.expanded.box_max_m.value());
}

TEST_F(TipPredictionTest, AnErrorOfUnknownSizeThatMattersLeavesNoExpandedFigure) {
  calib::IdentificationResult result = calib::identify(problem_, recipe_.identification);
  const int r1 = *calib::error_parameter_index("r1");
  result.uncertainty->unseen_without_tolerance = {r1};
  result.uncertainty->unknown_directions = calib::ArmVector::Unit(r1);
  const TipPrediction tip = predict_tip(TipRegions(edf()), problem_, result);
  EXPECT_EQ(tip.expanded.box_rms_m, std::nullopt);
  EXPECT_EQ(tip.expanded.box_max_m, std::nullopt);
  EXPECT_EQ(tip.unknown_errors, std::vector{r1});
  EXPECT_TRUE(tip.arm_frame.expanded.box_p95_m.has_value()) << "r1 is of the block's place";
}

TEST_F(TipPredictionTest, NothingIsPredictedOfWhatDidNotConverge) {
  problem_.touches.resize(3);
  const TipPrediction prediction = predict(edf());
  EXPECT_EQ(prediction.at_block_rms_m, std::nullopt);
  EXPECT_EQ(prediction.workspace_box_rms_m, std::nullopt);
  EXPECT_FALSE(prediction.map.has_value());
}

}  // namespace
}  // namespace cell
