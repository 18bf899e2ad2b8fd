#include "service/acquisition/plan_cache.hpp"

#include <gtest/gtest.h>

#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class PlanCacheTest : public ::testing::Test, public OwnersBench {
 protected:
  PlanCache plans_{io.get_executor(), cell_of_owners()};
};

TEST_F(PlanCacheTest, PlansARecipeOnceAndGivesItAgain) {
  EXPECT_FALSE(plans_.planned("few"));
  const auto first = std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few")));
  const auto again = std::get<std::shared_ptr<const Plan>>(run(plans_.plan("few")));
  EXPECT_EQ(first, again);
  EXPECT_EQ(first->id, plan_of_owners().id) << "planning is deterministic";
  EXPECT_EQ(plans_.plan_with_id(first->id), first);
  EXPECT_EQ(plans_.plan_with_id("another"), nullptr);
  EXPECT_FALSE(plans_.is_planning());
}

TEST_F(PlanCacheTest, APlanThatWasBegunBeforeTheBlockStoodElsewhereIsMadeAgain) {
  bool done = false;
  plans_.begin("few", [&done] { done = true; });
  io.poll();  // up to the planner's thread
  EXPECT_TRUE(plans_.is_planning());
  plans_.clear();
  io.restart();
  io.run();
  EXPECT_TRUE(done);
  EXPECT_TRUE(plans_.planned("few"));
  plans_.clear();
  EXPECT_FALSE(plans_.planned("few"));
}

}  // namespace
}  // namespace cell
