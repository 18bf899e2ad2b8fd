#include "service/run/decision_rule.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "calib_core/geometry/units.hpp"
#include "calib_core/numerics/distributions.hpp"
#include "service/documents/decision_rule_view.hpp"

namespace cell {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr int kHeldOut = 10;
constexpr double kMeanStdM = 8e-6;
constexpr double kNominalMissM = 0.012;
const JudgedTip kGoodTip{.box_rms_m = 5e-5, .box_max_m = 1.9e-4};

Cell cell_with_limits() {
  Cell cell;
  cell.nominal_position_error_m = kNominalMissM;
  cell.acceptance = {.held_out_mean_max_m = 3e-5, .held_out_rms_max_m = 5e-5, .condition_number_max = 300};
  return cell;
}

calib::IdentificationResult good_result() {
  calib::IdentificationResult result;
  result.status = calib::IdentificationStatus::kConverged;
  result.fitted_touch_count = 100;
  result.iterations = {{.condition_number = 200}};
  result.lack_of_fit.emplace().p_of_face = {0.4, 0.6};
  result.scale.emplace().significance = 0.5;
  result.scale->contradicted = 1.5;
  for (const int face : {0, 1}) {
    result.distances.push_back({.face = face,
                                .role = calib::TouchRole::kHeldOut,
                                .touch_count = kHeldOut,
                                .calibrated_mean_m = -1e-5,
                                .calibrated_rms_m = 2e-5,
                                .calibrated_mean_std_m = kMeanStdM});
  }
  return result;
}

std::vector<Criterion> list_of(const calib::IdentificationResult& result,
                               const Cell& cell = cell_with_limits(), const JudgedTip& tip = kGoodTip) {
  return criteria(result, Recipe{}, cell, tip, true);
}

const Criterion& named(const std::vector<Criterion>& list, const std::string& name,
                       std::optional<int> plane = std::nullopt) {
  const auto found = std::ranges::find_if(
      list, [&](const Criterion& one) { return one.name == name && one.plane == plane; });
  if (found == list.end()) throw std::logic_error("no criterion " + name);
  return *found;
}

TEST(Criteria, AreAllThatCanRejectAResult) {
  const auto list = list_of(good_result());
  for (const char* name : {"complete", "converged", "scale", "artefact", "condition_number", "lack_of_fit",
                           "rejected_touches", "held_parameters", "unknown_errors", "nominal_miss"})
    EXPECT_TRUE(named(list, name).within_limit()) << name;
  for (const int plane : {1, 2}) {
    for (const char* name : {"lack_of_fit", "held_out_mean", "held_out_rms"})
      EXPECT_TRUE(named(list, name, plane).within_limit()) << name;
  }
  EXPECT_EQ(list.size(), 16U);
}

TEST(Criteria, ARunThatWasNotCompletedOrDidNotConvergeMissesALimitOfItsOwn) {
  calib::IdentificationResult diverged = good_result();
  diverged.status = calib::IdentificationStatus::kNotConverged;
  diverged.message = "after 20 iterations";
  const auto list = criteria(diverged, Recipe{}, cell_with_limits(), kGoodTip, false);
  EXPECT_FALSE(named(list, "complete").within_limit());
  EXPECT_FALSE(named(list, "converged").within_limit());
  EXPECT_EQ(named(list, "converged").miss, "after 20 iterations");
}

TEST(Criteria, AGuardedRuleWantsTouchesHeldOut) {
  Cell guarded = cell_with_limits();
  guarded.acceptance.guarded = true;
  EXPECT_EQ(named(list_of(good_result(), guarded), "held_out_touches").value, 2.0 * kHeldOut);
  calib::IdentificationResult none = good_result();
  none.distances.clear();
  EXPECT_FALSE(named(list_of(none, guarded), "held_out_touches").within_limit());
  EXPECT_THAT(list_of(none), Each(Field(&Criterion::name, Not("held_out_touches"))))
      << "a simple rule does not";
}

TEST(Criteria, ACalibrationMustSayMoreOfTheTipThanWasAssumedBefore) {
  const auto of_tip = [](std::optional<double> box_max_m) {
    return list_of(good_result(), cell_with_limits(), {.box_max_m = box_max_m});
  };
  EXPECT_TRUE(named(of_tip(kNominalMissM), "nominal_miss").within_limit());
  for (const std::optional<double> too_large :
       {std::optional(1.001 * kNominalMissM), std::optional<double>()})
    EXPECT_FALSE(named(of_tip(too_large), "nominal_miss").within_limit());
  const Criterion miss = named(of_tip(0.028), "nominal_miss");
  EXPECT_EQ(miss.value, 28.0);
  EXPECT_THAT(miss.miss,
              HasSubstr("is 28.000 mm, but the uncalibrated arm misses by no more than 12.000 mm"));
  calib::IdentificationResult diverged = good_result();
  diverged.status = calib::IdentificationStatus::kNotConverged;
  EXPECT_THAT(list_of(diverged), Each(Field(&Criterion::name, Not("nominal_miss"))))
      << "that is a reason of its own";
}

TEST(Criteria, AnErrorOfUnknownSizeThatMovesTheTipIsNamed) {
  const int d1 = *calib::error_parameter_index("d1");
  const auto list = list_of(good_result(), cell_with_limits(), {.unknown_errors = {d1}});
  EXPECT_FALSE(named(list, "unknown_errors").within_limit());
  EXPECT_THAT(named(list, "unknown_errors").miss, HasSubstr("no touch shows d1 and"));
  EXPECT_THAT(list, Each(Field(&Criterion::name, Not("nominal_miss")))) << "told once";
}

TEST(Criteria, ScaleAndArtefactAreLimitedByTheirSignificance) {
  calib::IdentificationResult result = good_result();
  result.scale->significance = 1.1 * calib::kScaleSignificanceMax;
  result.scale->warning = "all lengths moved together";
  EXPECT_FALSE(named(list_of(result), "scale").within_limit());
  EXPECT_EQ(named(list_of(result), "scale").miss, "all lengths moved together");
  EXPECT_TRUE(named(list_of(result), "artefact").within_limit());
  result.scale->significance = 0.1;
  result.scale->contradicted = 1.1 * calib::kArtefactSignificanceMax;
  EXPECT_TRUE(named(list_of(result), "scale").within_limit());
  EXPECT_FALSE(named(list_of(result), "artefact").within_limit());
}

TEST(Criteria, AScaleThatNoTouchShowsIsMissed) {
  calib::IdentificationResult result = good_result();
  result.scale = calib::ScaleCheck{.warning = "no length was touched"};
  EXPECT_FALSE(named(list_of(result), "scale").within_limit());
  result.scale->warning.clear();
  EXPECT_THAT(list_of(result), Each(Field(&Criterion::name, Not("scale"))))
      << "no tolerance: nothing to judge";
}

TEST(Criteria, TheMeanHasTheUncertaintyOfEverythingInIt) {
  const Criterion mean = named(list_of(good_result()), "held_out_mean", 1);
  EXPECT_NEAR(mean.value.value(), 0.010, 1e-12);
  EXPECT_NEAR(mean.expanded_uncertainty.value(), 2e3 * kMeanStdM, 1e-12);
  calib::IdentificationResult unknown = good_result();
  unknown.distances[0].calibrated_mean_std_m.reset();
  EXPECT_EQ(named(list_of(unknown), "held_out_mean", 1).proved(), std::nullopt);
}

TEST(Criteria, TheTrueRmsIsWithinItsUncertaintyAsOftenAsKSays) {
  const Criterion rms = named(list_of(good_result()), "held_out_rms", 1);
  const double bound = *rms.value + rms.expanded_uncertainty.value();
  // A true rms at the bound gives one as small as the value so seldom.
  const double chance =
      1.0 - calib::chi_square_survival(kHeldOut * std::pow(*rms.value / bound, 2), kHeldOut);
  EXPECT_NEAR(chance, (1.0 - calib::normal_two_sided_confidence(kCoverageFactor)) / 2.0, 1e-9);
}

TEST(Criteria, ProvedIsSaidOnlyWhereValueAndUncertaintyAreWithinTheLimit) {
  const auto list = list_of(good_result());
  EXPECT_EQ(named(list, "condition_number").proved(), std::nullopt) << "no uncertainty: nothing to prove";
  EXPECT_EQ(named(list, "held_out_mean", 1).proved(), true);
  calib::IdentificationResult near = good_result();
  near.distances[0].calibrated_mean_m = 3e-5 - 1.9 * kMeanStdM;
  EXPECT_TRUE(named(list_of(near), "held_out_mean", 1).within_limit());
  EXPECT_EQ(named(list_of(near), "held_out_mean", 1).proved(), false);
}

TEST(Criteria, TheTipIsLimitedByItsRmsItsWorstPostureAndForEachTool) {
  Cell cell = cell_with_limits();
  EXPECT_EQ(list_of(good_result(), cell, {.box_rms_m = 1.0}).size(), 16U) << "no limit";
  cell.acceptance.tip_box_rms_max_m = 6e-5;
  cell.acceptance.tip_box_max_m = 2e-4;
  cell.acceptance.tool_box_rms_max_m = {{"gripper", 1e-4}};
  const JudgedTip good{.box_rms_m = 5e-5, .box_max_m = 1.9e-4, .tools = {{"gripper", 9e-5}, {"pen", 1.0}}};
  for (const char* name : {"tip_box_rms", "tip_box_max", "tool_box_rms"})
    EXPECT_TRUE(named(list_of(good_result(), cell, good), name).within_limit()) << name;
  const JudgedTip bad{.box_rms_m = 7e-5, .box_max_m = 2.1e-4, .tools = {{"gripper", 1.1e-4}}};
  for (const JudgedTip& tip : {bad, JudgedTip{.tools = {{"gripper", std::nullopt}}}}) {
    for (const char* name : {"tip_box_rms", "tip_box_max", "tool_box_rms"})
      EXPECT_FALSE(named(list_of(good_result(), cell, tip), name).within_limit()) << name;
  }
  EXPECT_EQ(named(list_of(good_result(), cell, bad), "tool_box_rms").tool, "gripper");
}

TEST(Criteria, TheLimitOfARecipeOutranksThatOfAll) {
  Cell cell = cell_with_limits();
  cell.acceptance.tip_box_max_m = 5e-3;
  cell.acceptance.tip_box_max_by_recipe_m = {{"quick", 1e-4}};
  const auto limit_mm = [&](const char* recipe) {
    return named(criteria(good_result(), Recipe{.name = recipe}, cell, kGoodTip, true), "tip_box_max").limit;
  };
  EXPECT_DOUBLE_EQ(limit_mm("quick"), 0.1);
  EXPECT_DOUBLE_EQ(limit_mm("edf-23"), 5.0);
  EXPECT_FALSE(named(criteria(good_result(), Recipe{.name = "quick"}, cell, kGoodTip, true), "tip_box_max")
                   .within_limit());
  cell.acceptance.tip_box_max_m.reset();
  EXPECT_DOUBLE_EQ(limit_mm("quick"), 0.1) << "alone as well";
}

TEST(DecisionRule, TheDocumentTellsEveryCriterion) {
  const Cell cell = cell_with_limits();
  const auto list = list_of(good_result());
  const DecisionRuleDocument rule = decision_rule_of(list, cell.acceptance);
  EXPECT_EQ(rule.standard, "ISO 14253-1:2017");
  EXPECT_EQ(rule.rule, "simple");
  ASSERT_EQ(rule.criteria.size(), list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(rule.criteria[i].name, list[i].name);
    EXPECT_EQ(rule.criteria[i].side, list[i].at_least ? "lower" : "upper");
    EXPECT_EQ(rule.criteria[i].proved, list[i].proved());
  }
  Cell guarded = cell;
  guarded.acceptance.guarded = true;
  EXPECT_EQ(decision_rule_of(list, guarded.acceptance).rule, "guarded");
}

}  // namespace
}  // namespace cell
