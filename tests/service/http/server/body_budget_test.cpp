#include "service/http/server/body_budget.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(BodyBudget, BodiesTakeItTogetherAndGiveItBackAtTheirEnd) {
  const auto budget = std::make_shared<BodyBudget>(100);
  BodyClaim first(budget);
  EXPECT_TRUE(first.grow_to(40));
  EXPECT_TRUE(first.grow_to(60)) << "20 more";
  {
    BodyClaim second(budget);
    EXPECT_FALSE(second.grow_to(41));
    EXPECT_EQ(budget->claimed_bytes(), 60u) << "a refused claim takes nothing";
    EXPECT_TRUE(second.grow_to(40));
    EXPECT_FALSE(first.grow_to(61));
  }
  EXPECT_EQ(budget->claimed_bytes(), 60u);
  EXPECT_TRUE(first.grow_to(100));
  EXPECT_TRUE(first.grow_to(1)) << "a body does not become smaller";
  EXPECT_EQ(budget->claimed_bytes(), 100u);
}

}  // namespace
}  // namespace cell
