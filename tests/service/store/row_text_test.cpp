#include "service/store/internal/row_text.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace cell {
namespace {

TEST(RowText, EveryChangeOfAPlanLeadsBackFromItsName) {
  for (const auto kind :
       {PlanChange::Kind::kDefer, PlanChange::Kind::kDropFitTouches, PlanChange::Kind::kSkip})
    EXPECT_EQ(row::plan_change_named(std::string(row::plan_change_name(kind))), kind);
  EXPECT_EQ(row::plan_change_name(PlanChange::Kind::kDefer), "put_off");
}

TEST(RowText, ATextThatNoVersionHasWrittenIsRefused) {
  EXPECT_THROW(row::plan_change_named("turned"), std::runtime_error);
  EXPECT_THROW(row::outcome_named("over"), std::runtime_error);
  EXPECT_THROW(row::verdict_named("good"), std::runtime_error);
}

}  // namespace
}  // namespace cell
