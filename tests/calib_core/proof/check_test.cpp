#include "calib_core/proof/check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/calib_core/proof/proved_cell.hpp"

namespace calib {
namespace {

using ::testing::HasSubstr;

constexpr double kScatterMetres = 5e-6;
constexpr int kTouchesOfCheck = 16;

class Check : public ::testing::Test {
 protected:
  Check() : touches_(cell_.touches_at(Eigen::Isometry3d::Identity(), cell_.true_arm(), kTouchesOfCheck)) {
    std::vector<ReferenceTime> times;
    for (int k = 0; k < kReferenceCount; ++k) times.push_back({made_by(cell_.true_arm())});
    reference_ = std::get<CheckReference>(make_reference(cell_.record(), times));
  }

  std::vector<Touch> made_by(const KinematicModel& arm) { return cell_.again(touches_, arm, kScatterMetres); }
  CheckVerdict verdict_of(const KinematicModel& arm) {
    return std::get<CheckVerdict>(check(cell_.record(), reference_, made_by(arm)));
  }
  std::string refusal_of(std::span<const Touch> touches) {
    const auto outcome = check(cell_.record(), reference_, touches);
    const auto* refusal = std::get_if<CheckRefusal>(&outcome);
    return refusal ? refusal->message : "";
  }

  proved::Cell cell_;
  std::vector<Touch> touches_;
  CheckReference reference_;
};

TEST_F(Check, KnowsTheScatterOfItsTouchesFromTheReference) {
  EXPECT_NEAR(reference_.noise.std_m, kScatterMetres, 0.5 * kScatterMetres);
  EXPECT_EQ(reference_.noise.degrees_of_freedom, 2.0 * (kTouchesOfCheck - 1));
}

TEST_F(Check, OfAnArmThatIsAsItWasIsQuiet) {
  const CheckVerdict verdict = verdict_of(cell_.true_arm());
  EXPECT_FALSE(verdict.alarm);
  EXPECT_EQ(verdict.cause, CheckCause::kNone);
}

TEST_F(Check, MeasuresTheArmsGrowthAndDoesNotAlarmOfIt) {
  constexpr double kExpansionPerK = 23e-6, kWarmerK = 8.0;
  const double growth = kExpansionPerK * kWarmerK;
  const CheckVerdict verdict =
      verdict_of(apply(cell_.true_arm(), errors_by_growth(cell_.true_arm(), growth)));
  EXPECT_FALSE(verdict.alarm);
  EXPECT_NEAR(verdict.growth, growth, 4.0 * verdict.std_growth);
  EXPECT_NEAR(verdict.warmer_k(kExpansionPerK).value(), kWarmerK, 2.0);
  EXPECT_FALSE(verdict.warmer_k(0.0));
}

TEST_F(Check, NamesTheJointThatSlipped) {
  for (const int joint : kCheckedJoints) {
    const double offset_rad = joint % 2 == 0 ? 0.2e-3 : -0.2e-3;
    const CheckVerdict verdict = verdict_of(proved::slipped(cell_.true_arm(), joint, offset_rad));
    EXPECT_TRUE(verdict.alarm) << joint;
    EXPECT_EQ(verdict.cause, CheckCause::kJoint) << joint;
    EXPECT_EQ(verdict.joint, joint);
    const CheckedJoint& found = verdict.joints[static_cast<std::size_t>(joint - kCheckedJoints.front())];
    EXPECT_NEAR(found.offset_rad, offset_rad, 4.0 * found.std_rad) << joint;
  }
}

TEST_F(Check, TellsAMovedBlockAndABentStylusFromAJoint) {
  const Eigen::Isometry3d moved =
      Eigen::Translation3d(0.1e-3, -0.05e-3, 0.1e-3) * Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(verdict_of(arm_at(cell_.true_arm(), moved)).cause, CheckCause::kBlock);
  ErrorVector bent = ErrorVector::Zero();
  bent[error_parameter_index("d7").value()] = 0.15e-3;
  EXPECT_EQ(verdict_of(apply(cell_.true_arm(), bent)).cause, CheckCause::kStylus);
}

TEST_F(Check, OfMoreThanOneFaultBlamesNoneOfThem) {
  const KinematicModel arm =
      proved::slipped(proved::slipped(proved::slipped(cell_.true_arm(), 3, 1e-3), 5, -2e-3), 4, 1e-3);
  const CheckVerdict verdict = verdict_of(arm);
  EXPECT_TRUE(verdict.alarm);
  EXPECT_EQ(verdict.cause, CheckCause::kUnknown);
  EXPECT_EQ(verdict.joint, 0);
}

TEST_F(Check, ABlockThatWasWarmerAtTheReferenceIsNoChange) {
  constexpr double kGrowth = 23e-6 * 12.0;  // aluminium, 12 K
  std::vector<ContactSurface> warm = cell_.record().problem().artefact.contact_planes;
  for (ContactSurface& plane : warm) plane.offset_m *= 1.0 + kGrowth;
  std::vector<ReferenceTime> told, untold;
  for (int k = 0; k < kReferenceCount; ++k) {
    std::vector<Touch> touches = made_by(cell_.true_arm());
    for (Touch& touch : touches) {
      const auto face = static_cast<std::size_t>(touch.face);
      ContactSurface plane = cell_.record().problem().artefact.contact_planes[face];
      // Where this touch met the block, as much further out as the block has grown there.
      plane.offset_m = plane.outward.dot(forward_kinematics(cell_.true_arm(), touch.joints).translation()) +
                       warm[face].offset_m - plane.offset_m;
      touch = moved_onto_plane(cell_.true_arm(), plane, touch);
    }
    told.push_back({touches, warm});
    untold.push_back({touches});
  }
  const auto since = [&](std::span<const ReferenceTime> times) {
    const auto reference = std::get<CheckReference>(make_reference(cell_.record(), times));
    return std::get<CheckVerdict>(check(cell_.record(), reference, made_by(cell_.true_arm())));
  };
  EXPECT_FALSE(since(told).alarm);
  EXPECT_NEAR(since(told).growth, 0.0, 4.0 * since(told).std_growth);
  const CheckVerdict wrong = since(untold);
  EXPECT_TRUE(wrong.alarm || std::abs(wrong.growth) > 4.0 * wrong.std_growth);
}

TEST_F(Check, OfOtherTouchesIsRefused) {
  std::vector<Touch> touches = made_by(cell_.true_arm());
  EXPECT_THAT(refusal_of(std::span(touches).first(5)), HasSubstr("5 touches where the reference has 16"));
  std::swap(touches[0], touches[1]);
  EXPECT_THAT(refusal_of(touches), HasSubstr("touch 1 is not where the reference has it"));
  std::swap(touches[0], touches[1]);
  touches[3].joints[0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal_of(touches), HasSubstr("touch 4 has a joint that is not a number"));
}

TEST_F(Check, ReferenceIsRefusedOfTwoTimesAndOfCopies) {
  std::vector<ReferenceTime> times(2, {made_by(cell_.true_arm())});
  EXPECT_THAT(std::get<CheckRefusal>(make_reference(cell_.record(), times)).message,
              HasSubstr("2 checks: a reference is the mean of 3"));
  times.push_back(times.front());
  EXPECT_THAT(std::get<CheckRefusal>(make_reference(cell_.record(), times)).message,
              HasSubstr("do not scatter at all"));
}

TEST_F(Check, OfTwoChecksItIsToldThatTheyAreOfNoOneReference) {
  const auto why = [this](const std::vector<ReferenceTime>& times) {
    const auto refusal = why_no_reference(cell_.record(), times);
    return refusal ? refusal->message : "";
  };
  const std::vector<Touch> first = made_by(cell_.true_arm());
  EXPECT_EQ(why({{first}}), "");
  EXPECT_EQ(why({{first}, {made_by(cell_.true_arm())}}), "");
  EXPECT_THAT(why({{first}, {first}}), HasSubstr("do not scatter at all"));
  std::vector<Touch> elsewhere = made_by(cell_.true_arm());
  elsewhere[2].joints[0] += 0.01;
  EXPECT_THAT(why({{first}, {elsewhere}}), HasSubstr("check 2 of the reference: touch 3 is not where"));
  elsewhere = made_by(cell_.true_arm());
  elsewhere[0].face = kTouchesOfCheck;
  EXPECT_THAT(why({{elsewhere}}), HasSubstr("touch 1 is on a plane that the block does not have"));
}

}  // namespace
}  // namespace calib
