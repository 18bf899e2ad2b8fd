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
  EXPECT_THROW(row::kind_named("trial"), std::runtime_error);
}

TEST(RowText, ARowIsNamedByItsTableItsRunAndItsNumber) {
  EXPECT_EQ(row::place_of("touches", 3, 12), "table touches, run 3, number 12");
  EXPECT_EQ(row::place_of("runs", 3), "table runs, run 3");
}

}  // namespace
}  // namespace cell
