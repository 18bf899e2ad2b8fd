#include "service/cli/plan_text.hpp"

#include <gmock/gmock.h>

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

PlanDocument plan_at_two_places() {
  PlanDocument plan;
  plan.plan_id = "p";
  plan.duration_s = 60.0;
  plan.planes = {{.plane = 2, .fit = 1}, {.plane = 8, .place = "stand", .fit = 1}};
  plan.touches = {{.plane = 2}, {.plane = 8, .place = "stand"}};
  return plan;
}

TEST(PlanText, SaysWhenThePersonHasToMoveTheBlock) {
  PlanDocument plan = plan_at_two_places();
  plan.leaving.emplace().push_back({.touches = 1});
  EXPECT_THAT(
      plan_text(plan),
      AllOf(HasSubstr(" mm  at stand\n"),
            HasSubstr("behind touch 1 the arm parks and waits until the block is brought to stand\n")));
  plan.leaving.reset();
  EXPECT_THAT(plan_text(plan), Not(HasSubstr("the arm parks")));
}

TEST(PlanText, SaysWhichFurtherTipTouches) {
  PlanDocument plan = plan_at_two_places();
  plan.planes[0].tip = "left";
  plan.planes[1].tip = "left";
  EXPECT_THAT(plan_text(plan), AllOf(HasSubstr(" mm  tip left\n"), HasSubstr(" mm  at stand, tip left\n")));
}

}  // namespace
}  // namespace cell
