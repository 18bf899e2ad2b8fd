#include "service/acquisition/restored_touches.hpp"

#include <gmock/gmock.h>

#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

constexpr int kTouchesMade = 6;

/// The first touches of the plan, as an arm without errors makes them.
std::vector<StoredTouch> planned_contacts() {
  std::vector<StoredTouch> touches;
  for (int i = 0; i < kTouchesMade; ++i) {
    const calib::PlannedTouch& planned = plan_of_owners().touches.touches[static_cast<std::size_t>(i)];
    touches.push_back({.number = i + 1,
                       .plane = planned.face + 1,
                       .role = planned.role,
                       .joints = to_wire(planned.joints)});
  }
  return touches;
}

class RestoredTouches : public ::testing::Test {
 protected:
  std::optional<std::string> why_not(const std::vector<StoredTouch>& touches, bool by_hand = false) {
    cell::Run run(1, regions_, cell_of_owners().recipes.at("few"), "start");
    run.restore(touches, 32);
    run.set_plan(plan_of_owners().touches);
    return why_not_of_plan(cell_of_owners(), run, by_hand);
  }

  TipRegions regions_{cell_of_owners()};
  std::vector<StoredTouch> touches_ = planned_contacts();
};

TEST_F(RestoredTouches, OfThePlanAreTaken) {
  EXPECT_FALSE(why_no_touches_of(cell_of_owners(), cell_of_owners().recipes.at("few"), touches_));
  EXPECT_FALSE(why_not(touches_));
  EXPECT_FALSE(why_not({}));
}

TEST_F(RestoredTouches, AtTheEndsOfTheirSearchAreTaken) {
  for (StoredTouch& touch : touches_) {
    const auto& planned = plan_of_owners().touches.touches[static_cast<std::size_t>(touch.number - 1)];
    touch.joints = to_wire(touch.number % 2 == 0 ? planned.approach_joints : planned.search_end_joints);
  }
  EXPECT_FALSE(why_not(touches_));
}

TEST_F(RestoredTouches, OnAnotherPlaneOrOfAnotherRoleAreRefused) {
  std::vector<StoredTouch> other = touches_;
  other[2].plane = other[2].plane % 5 + 1;
  EXPECT_THAT(why_not(other).value(), HasSubstr("touch 3 is on plane"));
  EXPECT_TRUE(why_not(other, true)) << "also by hand";
  other = touches_;
  other[4].role = calib::TouchRole::kProof;
  EXPECT_THAT(why_not(other).value(), HasSubstr("touch 5"));
}

TEST_F(RestoredTouches, FarFromThePlannedOneAreRefusedExceptByHand) {
  std::vector<StoredTouch> other = touches_;
  other[1].joints[0] += 8'000'000;  // 8 degrees
  EXPECT_THAT(why_not(other).value(), HasSubstr("touch 2 is"));
  EXPECT_FALSE(why_not(other, true));
  other = touches_;
  other[5].joints[5] += 10'000'000;  // the ball stays, the stylus turns
  EXPECT_THAT(why_not(other).value(), HasSubstr("touch 6 is"));
}

TEST_F(RestoredTouches, ThatDoNotFollowEachOtherOrAreOnNoPlaneAreRefusedBeforeThePlan) {
  std::vector<StoredTouch> other = touches_;
  other.erase(other.begin() + 2);
  EXPECT_THAT(why_no_touches_of(cell_of_owners(), cell_of_owners().recipes.at("few"), other).value(),
              HasSubstr("touch 3 is missing"));
  for (const int plane : {0, -1, 99}) {
    other = touches_;
    other[0].plane = plane;
    EXPECT_THAT(why_no_touches_of(cell_of_owners(), cell_of_owners().recipes.at("few"), other).value(),
                HasSubstr("which the block has not"));
  }
}

}  // namespace
}  // namespace cell
