#include "service/run/decision_rule.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "service/documents/decision_rule_view.hpp"

namespace cell {
namespace {

constexpr double kNoiseM = 2e-5;
constexpr int kHeldOut = 10;
constexpr double kTipBoxRms = 6e-5;

/// Two faces, exactly where they are written.
Cell cell_with(bool guarded) {
  Cell cell;
  cell.acceptance = {.held_out_mean_max_m = 3e-5, .held_out_rms_max_m = 5e-5, .condition_number_max = 300};
  cell.acceptance.guarded = guarded;
  cell.touch_noise_m = kNoiseM;
  cell.block.face_uncertainties.resize(2);
  return cell;
}

/// Below the limits of the held-out touches by these.
calib::IdentificationResult below_the_limits(double mean_m, double rms_m) {
  const AcceptanceLimits limits = cell_with(false).acceptance;
  calib::IdentificationResult result;
  result.status = calib::IdentificationStatus::kConverged;
  result.iterations = {{.condition_number = limits.condition_number_max}};
  for (const int face : {0, 1}) {
    result.distances.push_back({.face = face,
                                .role = calib::TouchRole::kHeldOut,
                                .touch_count = kHeldOut,
                                .calibrated_mean_m = mean_m - limits.held_out_mean_max_m,
                                .calibrated_rms_m = limits.held_out_rms_max_m - rms_m});
  }
  return result;
}

TEST(DecisionRule, AGuardedCellWantsValueAndUncertaintyWithinTheLimit) {
  const double mean_guard_m = kCoverageFactor * kNoiseM / std::sqrt(kHeldOut);
  const double rms_guard_m = kCoverageFactor * kNoiseM / std::sqrt(2.0 * kHeldOut);
  for (const double part : {0.0, 0.999, 1.001}) {
    const calib::IdentificationResult result = below_the_limits(part * mean_guard_m, part * rms_guard_m);
    EXPECT_TRUE(judge_by_rule(result, {}, cell_with(false), kTipBoxRms, true).accepted) << part;
    const Judgement guarded = judge_by_rule(result, {}, cell_with(true), kTipBoxRms, true);
    EXPECT_EQ(guarded.accepted, part > 1.0) << part;
    EXPECT_EQ(guarded.reasons.size(), part > 1.0 ? 0U : 4U) << "mean and rms of two planes";
  }
}

TEST(DecisionRule, WhatIsOutOfItsLimitIsToldOnce) {
  const calib::IdentificationResult result = below_the_limits(-1e-6, -1e-6);
  EXPECT_EQ(judge_by_rule(result, {}, cell_with(true), kTipBoxRms, true).reasons,
            judge_by_rule(result, {}, cell_with(false), kTipBoxRms, true).reasons);
}

TEST(DecisionRule, TellsEveryCriterionWithItsUncertainty) {
  Cell cell = cell_with(false);
  constexpr double kStdFaceM = 5e-6;
  cell.block.face_uncertainties[1].std_offset_m = kStdFaceM;
  const auto list = criteria(below_the_limits(0.0, 0.0), cell, kTipBoxRms);
  ASSERT_EQ(list.size(), 5U) << "mean and rms of two planes, condition number";
  const double noise_part_m = kNoiseM / std::sqrt(kHeldOut);
  EXPECT_NEAR(list[0].expanded_uncertainty.value(), 2 * calib::mm_from_metres(noise_part_m), 1e-12);
  EXPECT_NEAR(list[2].expanded_uncertainty.value(),
              2 * calib::mm_from_metres(std::hypot(noise_part_m, kStdFaceM)), 1e-12);
  EXPECT_FALSE(list[4].expanded_uncertainty.has_value());
  const DecisionRuleDocument rule = decision_rule_of(list, cell.acceptance);
  EXPECT_EQ(rule.standard, "ISO 14253-1");
  EXPECT_EQ(rule.rule, "simple");
  EXPECT_EQ(rule.criteria.at(0).within_limit, true);
  EXPECT_EQ(rule.criteria.at(0).proved, false);
  EXPECT_EQ(rule.criteria.at(4).proved, true);
  EXPECT_EQ(rule.criteria.at(4).expanded_uncertainty, std::nullopt);
  EXPECT_EQ(decision_rule_of(list, cell_with(true).acceptance).rule, "guarded");
}

TEST(DecisionRule, AFigureThatIsNotThereIsNotWithinItsLimit) {
  Cell cell = cell_with(false);
  cell.acceptance.tip_box_rms_max_m = kTipBoxRms;
  const auto list = criteria(below_the_limits(0.0, 0.0), cell, std::nullopt);
  EXPECT_EQ(list.back().name, "tip_box_rms");
  EXPECT_FALSE(list.back().within_limit());
  EXPECT_EQ(decision_rule_of(list, cell.acceptance).criteria.back().value, std::nullopt);
}

}  // namespace
}  // namespace cell
