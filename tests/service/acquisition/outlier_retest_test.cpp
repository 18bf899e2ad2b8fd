#include "service/acquisition/outlier_retest.hpp"

#include <gtest/gtest.h>

#include "service/run/planning_problem.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

constexpr double kAgreementMetres = 1e-4;

StoredTouch stored(int number, const calib::Touch& touch) {
  return {.number = number, .plane = touch.face + 1, .role = touch.role, .joints = to_wire(touch.joints)};
}

/// What is known behind the first forty touches of the paper's arm, and the next of them.
class OutlierRetestTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kKnown = 40;

  OutlierRetestTest() {
    static const calib::PlanningProblem problem = planning_problem(edf(), edf().recipes.at("edf-25"));
    static const calib::OnlineArmEstimate known = [] {
      calib::OnlineArmEstimate aim(problem);
      for (std::size_t i = 0; i < kKnown; ++i) aim.add(table3_touches()[i]);
      return aim;
    }();
    const calib::JointVector& joints = table3_touches()[kKnown].joints;
    const calib::PlannedTouch touch{
        table3_touches()[kKnown].face, calib::TouchRole::kFit, joints, joints, joints, joints,
        Eigen::Vector3d::UnitX()};
    retest_.begin({kKnown + 1, {touch, problem}, known});
  }
  static StoredTouch good() { return stored(kKnown + 1, table3_touches()[kKnown]); }
  /// Tens of millimetres beside.
  static StoredTouch wrong() {
    calib::Touch touch = table3_touches()[kKnown];
    touch.joints[1] += 0.05;
    touch.joints[2] -= 0.02;
    return stored(kKnown + 1, touch);
  }

  OutlierRetest retest_;
};

TEST_F(OutlierRetestTest, TwoTouchesThatAgreeStayAsAWarning) {
  const auto found = retest_.judge(wrong(), wrong(), 0.9 * kAgreementMetres, kAgreementMetres);
  EXPECT_EQ(std::get<OutlierRetest::Confirmed>(found).warning.code, FaultCode::kTouchOutlier);
}

TEST_F(OutlierRetestTest, APairIsWhatAgreesAndWasLatchedTwice) {
  EXPECT_TRUE(OutlierRetest::is_pair(wrong(), wrong(), 0.9 * kAgreementMetres, kAgreementMetres));
  EXPECT_FALSE(OutlierRetest::is_pair(wrong(), good(), 1.1 * kAgreementMetres, kAgreementMetres));
  StoredTouch polled = good();
  polled.source = cs8::CaptureSource::kPolled;
  EXPECT_FALSE(OutlierRetest::is_pair(polled, good(), 0.0, kAgreementMetres));
  EXPECT_FALSE(OutlierRetest::is_pair(good(), polled, 0.0, kAgreementMetres));
}

TEST_F(OutlierRetestTest, ARepetitionThatFitsTakesTheTouchsPlaceAndAims) {
  const auto found = retest_.judge(wrong(), good(), 0.02, kAgreementMetres);
  const auto& replaced = std::get<OutlierRetest::Replaced>(found);
  EXPECT_EQ(replaced.again.joints, good().joints);
  EXPECT_EQ(replaced.aim.touch_count(), kKnown + 1);
  EXPECT_EQ(retest_.suspect().without.touch_count(), kKnown) << "what was known without it stays known";
}

TEST_F(OutlierRetestTest, WhenNeitherFitsAPersonIsAsked) {
  const auto found = retest_.judge(good(), wrong(), 0.02, kAgreementMetres);
  EXPECT_EQ(std::get<OutlierRetest::Held>(found).fault.code, FaultCode::kTouchDoesNotFit);
}

/// The forty touches, of which the first lies beside, and the suspicion against it at their end.
class OutlierAtEnd : public OutlierRetestTest {
 protected:
  OutlierAtEnd() {
    OutlierRetest::Suspect before = retest_.suspect();
    calib::Touch beside = table3_touches()[0];
    beside.joints[1] += 0.05;
    calib::OnlineArmEstimate aim(before.aimed.problem);
    aim.add(beside);
    for (std::size_t i = 1; i < kKnown; ++i) aim.add(table3_touches()[i]);
    retest_.begin({1, std::move(before.aimed), std::move(aim), true});
  }
  StoredTouch first_ = stored(1, table3_touches()[0]);
};

TEST_F(OutlierAtEnd, ARepetitionThatFitsTakesThePlaceOfTheEarlyTouch) {
  EXPECT_EQ(retest_.suspect().without.contradicted(), std::vector<std::size_t>{0});
  const auto found = retest_.judge(first_, first_, 0.02, kAgreementMetres);
  const auto& replaced = std::get<OutlierRetest::Replaced>(found);
  EXPECT_EQ(replaced.aim.touch_count(), kKnown);
  EXPECT_TRUE(replaced.aim.contradicted().empty());
}

TEST_F(OutlierAtEnd, WhenNeitherFitsTheResultLeavesItOutWithAWarning) {
  StoredTouch again = wrong();
  again.number = 1;
  again.plane = first_.plane;
  const auto found = retest_.judge(first_, again, 0.02, kAgreementMetres);
  EXPECT_EQ(std::get<OutlierRetest::Confirmed>(found).warning.code, FaultCode::kTouchOutlier);
}

TEST_F(OutlierAtEnd, SuspectsAreThoseOfTheResultTheWorstFirstAndThenThoseOfTheEstimate) {
  calib::IdentificationResult result;
  result.rejected = {{4, 0.001, calib::RejectionReason::kOutlier},
                     {7, -0.003, calib::RejectionReason::kOutlier}};
  const std::vector<int> suspects = suspects_of(result, retest_.suspect().without);
  EXPECT_EQ(suspects, (std::vector<int>{8, 5, 1}));
  EXPECT_EQ(retest_.warning_of(suspects).code, FaultCode::kTouchOutlier);
  EXPECT_EQ(retest_.warning_of(suspects).detail,
            "touch 8 (not made again), touch 5 (not made again), touch 1");
}

TEST_F(OutlierAtEnd, ATouchThatBothSuspectIsNamedOnce) {
  calib::IdentificationResult result;
  result.rejected = {{0, 0.001, calib::RejectionReason::kOutlier}};
  EXPECT_EQ(suspects_of(result, retest_.suspect().without), std::vector<int>{1});
}

TEST_F(OutlierRetestTest, ADifferenceOfAllThatTwoTouchesMayHaveIsAgreement) {
  const auto found = retest_.judge(wrong(), good(), kAgreementMetres, kAgreementMetres);
  EXPECT_TRUE(std::holds_alternative<OutlierRetest::Confirmed>(found));
  EXPECT_TRUE(OutlierRetest::is_pair(wrong(), good(), kAgreementMetres, kAgreementMetres));
}

TEST_F(OutlierRetestTest, ANewRunKnowsNothingOfTheLastOne) {
  EXPECT_TRUE(retest_.was_made_again(kKnown + 1));
  retest_.begin_run();
  EXPECT_FALSE(retest_.is_due());
  EXPECT_FALSE(retest_.was_made_again(kKnown + 1));
}

TEST_F(OutlierRetestTest, IsDueUntilItIsSettled) {
  EXPECT_TRUE(retest_.is_due());
  retest_.settle();
  EXPECT_FALSE(retest_.is_due());
}

}  // namespace
}  // namespace cell
