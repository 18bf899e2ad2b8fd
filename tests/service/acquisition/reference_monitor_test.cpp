#include "service/acquisition/reference_monitor.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

/// Here the height of the ball is the first joint, in metres.
double first_joint(const calib::JointVector& joints) { return joints[0]; }

calib::JointVector at(double height_m) {
  calib::JointVector joints = calib::JointVector::Zero();
  joints[0] = height_m;
  return joints;
}

calib::PlannedTouch planned(int face, calib::TouchRole role) {
  const calib::JointVector joints = calib::JointVector::Zero();
  return {face, role, joints, joints, joints, joints, Eigen::Vector3d::UnitX()};
}

constexpr double kLimitMetres = 1e-3;
constexpr bool kMoreToMake = false, kAllMade = true;

class ReferenceMonitorTest : public ::testing::Test {
 protected:
  ReferenceMonitorTest() {
    monitor_.begin_run(5);
    monitor_.note_fitted(planned(0, calib::TouchRole::kFit), at(0.0));
  }
  std::optional<Fault> touch(double height_m, int touches_done) {
    monitor_.add_contact(at(height_m), touches_done, first_joint);
    return monitor_.drift_fault(kLimitMetres);
  }
  std::optional<ReferenceMonitor::Doubt> doubt(double height_m) {
    return monitor_.doubt(at(height_m), kLimitMetres, first_joint);
  }

  ReferenceMonitor monitor_;
};

TEST_F(ReferenceMonitorTest, IsDueAtTheStartBehindEverySoManyTouchesAndAtTheEnd) {
  EXPECT_TRUE(monitor_.is_due(1, kMoreToMake));
  touch(0.0, 1);
  for (const int done : {1, 2, 3, 4, 6}) EXPECT_FALSE(monitor_.is_due(done, kMoreToMake)) << done;
  EXPECT_TRUE(monitor_.is_due(5, kMoreToMake));
  touch(0.0, 5);
  EXPECT_FALSE(monitor_.is_due(5, kMoreToMake)) << "once is enough";
  EXPECT_TRUE(monitor_.is_due(7, kAllMade));
}

TEST_F(ReferenceMonitorTest, IsDueWheneverTheRunWasOutOfHands) {
  touch(0.0, 1);
  monitor_.make_due();
  EXPECT_TRUE(monitor_.is_due(1, kMoreToMake));
  touch(0.0, 1);
  EXPECT_FALSE(monitor_.is_due(1, kMoreToMake));
  monitor_.begin_run(5);
  monitor_.make_due();
  EXPECT_FALSE(monitor_.is_due(0, kMoreToMake)) << "there is no place yet";
}

TEST_F(ReferenceMonitorTest, ATouchThatIsLeftOutBeforeItWasTouchedAgainSetsNoPlace) {
  monitor_.begin_place();
  monitor_.note_fitted(planned(0, calib::TouchRole::kFit), at(0.0));
  EXPECT_TRUE(monitor_.is_due(1, kMoreToMake));
  monitor_.forget_untouched();
  EXPECT_FALSE(monitor_.is_due(0, kMoreToMake));
  monitor_.note_fitted(planned(1, calib::TouchRole::kFit), at(0.0));
  touch(0.0, 1);
  monitor_.forget_untouched();
  monitor_.make_due();
  EXPECT_TRUE(monitor_.is_due(1, kMoreToMake)) << "one that was touched again stays";
}

TEST_F(ReferenceMonitorTest, ARecipeWithoutOneNeverWantsIt) {
  monitor_.begin_run(0);
  monitor_.note_fitted(planned(0, calib::TouchRole::kFit), at(0.0));
  EXPECT_FALSE(monitor_.is_due(1, kMoreToMake));
  EXPECT_FALSE(monitor_.is_due(8, kAllMade));
}

TEST_F(ReferenceMonitorTest, IsWhereTheFirstFittedTouchIs) {
  monitor_.begin_run(5);
  monitor_.note_fitted(planned(1, calib::TouchRole::kHeldOut), at(0.0));
  EXPECT_FALSE(monitor_.is_due(1, kMoreToMake)) << "a held-out touch is none";
  monitor_.note_fitted(planned(2, calib::TouchRole::kFit), at(0.0));
  monitor_.note_fitted(planned(3, calib::TouchRole::kFit), at(0.0));
  EXPECT_EQ(monitor_.planned().face, 2);
}

TEST_F(ReferenceMonitorTest, DriftCountsFromTheFirstContactThere) {
  const auto first = monitor_.add_contact(at(0.0004), 1, first_joint);
  EXPECT_EQ(first.number, 1);
  EXPECT_FALSE(first.told_m);
  const auto second = monitor_.add_contact(at(0.0009), 5, first_joint);
  EXPECT_EQ(second.number, 2);
  EXPECT_NEAR(second.told_m.value(), 0.0005, 1e-12);
}

TEST_F(ReferenceMonitorTest, AFirstContactNearThePlansOwnIsTheReference) {
  EXPECT_FALSE(doubt(0.0009));
  touch(0.0009, 1);
  EXPECT_FALSE(doubt(0.9)) << "what comes later is drift";
}

TEST_F(ReferenceMonitorTest, WhereTheTouchOfThePlanWasBiasedItsRepetitionsAgree) {
  const auto first = doubt(0.005);
  ASSERT_TRUE(first && first->warning && !first->hold);
  EXPECT_EQ(first->warning->code, FaultCode::kFirstTouchBiased);
  EXPECT_EQ(first->warning->detail, "by 5.000 mm; it is touched again");
  EXPECT_TRUE(monitor_.is_due(1, kMoreToMake)) << "it does not count";
  EXPECT_FALSE(doubt(0.0055));
  EXPECT_FALSE(touch(0.0055, 1));
  EXPECT_EQ(touch(0.0, 5).value().code, FaultCode::kReferenceDrift) << "drift counts from the repetition";
}

/// It was the base of the drift of the whole run: 90 good touches were rejected with it.
TEST_F(ReferenceMonitorTest, AContactThatNothingAgreesWithIsNoReference) {
  EXPECT_TRUE(doubt(-0.005));
  EXPECT_FALSE(doubt(0.0002));
  EXPECT_FALSE(touch(0.0002, 1));
  EXPECT_FALSE(touch(0.0, 5));
}

TEST_F(ReferenceMonitorTest, WhereNothingAgreesAPersonLooksAtIt) {
  EXPECT_TRUE(doubt(0.005));
  const auto second = doubt(0.008);
  ASSERT_TRUE(second && second->hold && !second->warning);
  EXPECT_EQ(second->hold->code, FaultCode::kReferenceDrift);
  EXPECT_TRUE(doubt(-0.004)->hold) << "looked at again, and there is none still";
  monitor_.allow_drift();
  EXPECT_FALSE(doubt(0.011)) << "by a person's word";
  EXPECT_FALSE(touch(0.011, 1));
}

TEST_F(ReferenceMonitorTest, DriftOverTheLimitHoldsUntilAPersonAllowsIt) {
  touch(0.0, 1);
  EXPECT_FALSE(touch(0.0009, 5));
  EXPECT_EQ(touch(0.0012, 10).value().code, FaultCode::kReferenceDrift);
  monitor_.allow_drift();
  EXPECT_FALSE(touch(0.0020, 15)) << "less than the limit from what was allowed";
  EXPECT_TRUE(touch(0.0023, 20));
}

TEST_F(ReferenceMonitorTest, APersonsWordIsToLookAgainOrToGoOnWithout) {
  touch(0.0, 5);
  monitor_.look_again();
  EXPECT_TRUE(monitor_.is_due(5, kMoreToMake));
  monitor_.skip(5);
  EXPECT_FALSE(monitor_.is_due(5, kMoreToMake));
}

TEST_F(ReferenceMonitorTest, APersonsWordToLookAgainHoldsBetweenTwoDueTouchesToo) {
  monitor_.restore(planned(4, calib::TouchRole::kFit), at(0.0), at(0.0), 0, 3);
  EXPECT_TRUE(touch(0.0012, 7));
  monitor_.look_again();
  EXPECT_TRUE(monitor_.is_due(7, kMoreToMake)) << "seven is no multiple of five";
}

TEST_F(ReferenceMonitorTest, ARestartedDaemonLooksAgainBeforeAnythingElse) {
  monitor_.begin_run(5);
  monitor_.restore(planned(4, calib::TouchRole::kFit), at(0.0), at(0.0), 0, 3);
  EXPECT_TRUE(monitor_.is_due(7, kMoreToMake));
  const auto reading = monitor_.add_contact(at(0.0002), 7, first_joint);
  EXPECT_EQ(reading.number, 4);
  EXPECT_NEAR(reading.told_m.value(), 0.0002, 1e-12) << "against the contact of the daemon before";
  EXPECT_FALSE(monitor_.is_due(7, kMoreToMake));
}

TEST_F(ReferenceMonitorTest, ARestartedDaemonHasNoPlaceWhereTheRecipeWantsNone) {
  monitor_.begin_run(0);
  monitor_.restore(planned(4, calib::TouchRole::kFit), at(0.0), at(0.0), 0, 3);
  EXPECT_FALSE(monitor_.is_due(7, kMoreToMake));
  monitor_.begin_run(1);
  monitor_.restore(planned(4, calib::TouchRole::kFit), at(0.0), at(0.0), 0, 3);
  EXPECT_TRUE(monitor_.is_due(7, kMoreToMake)) << "behind each touch";
}

TEST_F(ReferenceMonitorTest, TheLimitItselfIsAllowed) {
  EXPECT_FALSE(doubt(kLimitMetres));
  EXPECT_FALSE(touch(kLimitMetres, 1));
  EXPECT_FALSE(touch(2 * kLimitMetres, 5));
}

TEST_F(ReferenceMonitorTest, TheBiasCountsFromThePlansOwnTouch) {
  monitor_.begin_run(5);
  monitor_.note_fitted(planned(0, calib::TouchRole::kFit), at(0.5));
  EXPECT_FALSE(doubt(0.5));
  monitor_.begin_run(5);
  monitor_.note_fitted(planned(0, calib::TouchRole::kFit), at(0.5));
  EXPECT_EQ(doubt(0.498).value().warning.value().detail, "by -2.000 mm; it is touched again");
}

TEST_F(ReferenceMonitorTest, AFirstContactThatAPersonSkipsCountsAsMade) {
  monitor_.skip(1);
  EXPECT_FALSE(monitor_.is_due(1, kMoreToMake));
  EXPECT_EQ(monitor_.add_contact(at(0.0), 5, first_joint).number, 2);
  monitor_.skip(6);
  EXPECT_EQ(monitor_.add_contact(at(0.0), 10, first_joint).number, 3) << "one that was made is no more";
}

}  // namespace
}  // namespace cell
