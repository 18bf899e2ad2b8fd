#include "service/run/verdict.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const AcceptanceLimits kLimits{
    .held_out_mean_max_m = 3e-5, .held_out_rms_max_m = 5e-5, .condition_number_max = 300};

constexpr double kTipBoxRms = 6e-5;
constexpr double kNominalMiss = 0.012;

calib::FaceDistances held_out(int face, double mean_m, double rms_m) {
  return {.face = face,
          .role = calib::TouchRole::kHeldOut,
          .touch_count = 10,
          .calibrated_mean_m = mean_m,
          .calibrated_rms_m = rms_m};
}

/// Exactly at every limit.
calib::IdentificationResult at_the_limits() {
  calib::IdentificationResult result;
  result.status = calib::IdentificationStatus::kConverged;
  result.iterations = {{.condition_number = 1e6}, {.condition_number = kLimits.condition_number_max}};
  result.distances = {held_out(0, kLimits.held_out_mean_max_m, kLimits.held_out_rms_max_m),
                      held_out(1, -kLimits.held_out_mean_max_m, kLimits.held_out_rms_max_m)};
  return result;
}

Judgement judged(const calib::IdentificationResult& result, const AcceptanceLimits& limits = kLimits,
                 std::optional<double> tip_box_rms_m = kTipBoxRms, bool complete = true,
                 const calib::IdentificationOptions& options = {}) {
  Cell cell;
  cell.nominal_position_error_m = kNominalMiss;
  cell.acceptance = limits;
  const JudgedTip tip{.box_rms_m = tip_box_rms_m, .box_max_m = kNominalMiss};
  const Recipe recipe{.identification = options};
  return judge(criteria(result, recipe, cell, tip, complete), limits);
}

std::vector<std::string> reasons_against(const calib::IdentificationResult& result, bool complete = true) {
  const Judgement judgement = judged(result, kLimits, kTipBoxRms, complete);
  EXPECT_EQ(judgement.accepted, judgement.reasons.empty());
  return judgement.reasons;
}

TEST(Verdict, AResultAtItsLimitsIsAccepted) { EXPECT_THAT(reasons_against(at_the_limits()), IsEmpty()); }

TEST(Verdict, ARunWithTouchesMissingIsNot) {
  EXPECT_THAT(reasons_against(at_the_limits(), false), ElementsAre(HasSubstr("was not completed")));
}

TEST(Verdict, AResultThatDidNotConvergeIsRefusedWithItsOwnMessage) {
  calib::IdentificationResult result = at_the_limits();
  result.status = calib::IdentificationStatus::kUnobservable;
  result.message = "planes 1 to 3 give no length";
  EXPECT_THAT(reasons_against(result), ElementsAre("planes 1 to 3 give no length"));
}

TEST(Verdict, TheConditionNumberOfTheLastIterationCounts) {
  calib::IdentificationResult result = at_the_limits();
  result.iterations.back().condition_number = 301;
  EXPECT_THAT(reasons_against(result), ElementsAre(HasSubstr("condition number is 301, the limit 300")));
}

TEST(Verdict, EveryMissIsAReasonOfItsOwnWithPlaneAndLimit) {
  calib::IdentificationResult result = at_the_limits();
  result.distances = {held_out(0, -4e-5, 6e-5), held_out(3, 4e-5, 1e-5)};
  EXPECT_THAT(reasons_against(result),
              ElementsAre(HasSubstr("plane 1 are off by -0.040 mm in the mean, the limit is 0.030 mm"),
                          HasSubstr("plane 1 scatter by 0.060 mm rms, the limit is 0.050 mm"),
                          HasSubstr("plane 4 are off by 0.040 mm")));
}

TEST(Verdict, TouchesThatWereFittedProveNothing) {
  calib::IdentificationResult result = at_the_limits();
  for (const auto role : {calib::TouchRole::kFit, calib::TouchRole::kProof}) {
    calib::FaceDistances far = held_out(2, 1, 1);
    far.role = role;
    result.distances.push_back(far);
  }
  EXPECT_THAT(reasons_against(result), IsEmpty());
}

TEST(Verdict, AFigureThatIsNoNumberIsNeverAccepted) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  calib::IdentificationResult condition = at_the_limits();
  condition.iterations.back().condition_number = nan;
  EXPECT_EQ(reasons_against(condition).size(), 1u);
  calib::IdentificationResult distance = at_the_limits();
  distance.distances = {held_out(0, nan, nan)};
  EXPECT_EQ(reasons_against(distance).size(), 2u);
}

TEST(Verdict, AScaleWarningIsAReason) {
  calib::IdentificationResult result = at_the_limits();
  result.scale.emplace().warning = "all lengths moved together";
  EXPECT_THAT(reasons_against(result), ElementsAre("all lengths moved together"));
}

TEST(Verdict, ResidualsThatAreNoTouchNoiseAreAReason) {
  calib::IdentificationResult result = at_the_limits();
  result.lack_of_fit.emplace().p = kLimits.lack_of_fit_p_min;
  EXPECT_THAT(reasons_against(result), IsEmpty());
  result.lack_of_fit->p = 0.9 * kLimits.lack_of_fit_p_min;
  EXPECT_THAT(reasons_against(result), ElementsAre(HasSubstr("lack of fit")));
}

TEST(Verdict, ASetWithHeldErrorsIsIncompleteButNotWithAPrior) {
  calib::IdentificationResult result = at_the_limits();
  const auto d3 = static_cast<std::size_t>(calib::error_parameter_index("d3").value());
  result.identifiable.candidates[d3].status = calib::ParameterStatus::kWeak;
  EXPECT_THAT(reasons_against(result),
              ElementsAre(::testing::AllOf(HasSubstr("incomplete set"), HasSubstr("d3"))));
  EXPECT_TRUE(judged(result, kLimits, kTipBoxRms, true, {.prior = true}).accepted);
}

TEST(Verdict, ATipUncertaintyOverItsLimitOrUnknownIsAReason) {
  AcceptanceLimits limits = kLimits;
  limits.tip_box_rms_max_m = kTipBoxRms;
  EXPECT_TRUE(judged(at_the_limits(), limits).accepted);
  EXPECT_THAT(judged(at_the_limits(), limits, 1.5 * kTipBoxRms).reasons,
              ElementsAre(HasSubstr("in the workspace box is 0.090 mm, the limit is 0.060 mm")));
  EXPECT_THAT(judged(at_the_limits(), limits, std::nullopt).reasons, ElementsAre(HasSubstr("unknown")));
}

TEST(Verdict, MoreThanATenthOfTheTouchesRejectedIsAReason) {
  calib::IdentificationResult result = at_the_limits();
  result.fitted_touch_count = 90;
  result.rejected.resize(10);
  EXPECT_THAT(reasons_against(result), IsEmpty());
  result.fitted_touch_count = 89;
  EXPECT_EQ(reasons_against(result).size(), 1u) << "10 of 99";
}

TEST(Verdict, AGuardedCellWantsValueAndUncertaintyWithinTheLimit) {
  AcceptanceLimits guarded = kLimits;
  guarded.guarded = true;
  for (const double part : {0.0, 0.999, 1.001}) {
    calib::IdentificationResult result = at_the_limits();
    for (calib::FaceDistances& face : result.distances) {
      face.calibrated_mean_std_m = 8e-6;
      face.calibrated_mean_m = kLimits.held_out_mean_max_m - part * kCoverageFactor * 8e-6;
      face.calibrated_rms_m = 1e-5;
    }
    EXPECT_TRUE(judged(result).accepted) << part;
    const Judgement judgement = judged(result, guarded);
    EXPECT_EQ(judgement.accepted, part > 1.0) << part;
    EXPECT_THAT(judgement.reasons, ::testing::AllOf(::testing::SizeIs(part > 1.0 ? 0U : 2U),
                                                    ::testing::Each(HasSubstr("not proved"))));
  }
}

TEST(Verdict, AGuardedCellWantsHeldOutTouchesAndTheirUncertainty) {
  AcceptanceLimits guarded = kLimits;
  guarded.guarded = true;
  calib::IdentificationResult result = at_the_limits();
  result.distances.clear();
  EXPECT_TRUE(judged(result).accepted);
  EXPECT_THAT(judged(result, guarded).reasons, ElementsAre(HasSubstr("no touch was held out")));
  result.distances = {held_out(0, 0.0, 1e-5)};
  EXPECT_THAT(judged(result, guarded).reasons, ElementsAre(HasSubstr("unknown size")));
}

TEST(Verdict, WhatIsOutOfItsLimitIsToldOnce) {
  AcceptanceLimits guarded = kLimits;
  guarded.guarded = true;
  calib::IdentificationResult result = at_the_limits();
  result.distances = {held_out(0, -4e-5, 6e-5)};
  EXPECT_EQ(judged(result, guarded).reasons, judged(result).reasons);
}

TEST(Verdict, NamesAreTheContracts) {
  EXPECT_EQ(verdict_name(Verdict::kNone), "none");
  EXPECT_EQ(verdict_name(Verdict::kAccepted), "accepted");
  EXPECT_EQ(verdict_name(Verdict::kRejected), "rejected");
  EXPECT_EQ(verdict_name(Verdict::kIncomplete), "incomplete");
}

}  // namespace
}  // namespace cell
