#include "calib_core/observability/identifiability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace calib {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Identifiability, GroupsADependentColumnWithItsFactor) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(6, kErrorParameterCount);
  w(0, 0) = 1.0;
  w(0, 1) = 2.0;  // twice column 0
  w(1, 3) = 3.0;
  const IdentifiableSet set = choose_identifiable(w, {});
  EXPECT_THAT(set.columns, ElementsAre(0, 3));
  EXPECT_EQ(set.candidates[1].status, ParameterStatus::kGrouped);
  EXPECT_THAT(set.candidates[1].grouped_with, ElementsAre(Pair(0, ::testing::DoubleEq(2.0))));
  EXPECT_EQ(set.candidates[2].status, ParameterStatus::kNoEffect);
  EXPECT_DOUBLE_EQ(set.smallest_kept, 1.0);
}

TEST(Identifiability, TriesTheGivenColumnsLastAndLeavesOutTheExcluded) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(6, kErrorParameterCount);
  w(0, 0) = 1.0;
  w(0, 1) = 2.0;
  w(1, 3) = 3.0;
  const IdentifiableSet set = choose_identifiable(w, {.tried_last = {0}, .excluded = {3}});
  EXPECT_THAT(set.columns, ElementsAre(1));
  EXPECT_EQ(set.candidates[0].status, ParameterStatus::kGrouped);
  EXPECT_EQ(set.candidates[3].status, ParameterStatus::kExcluded);
}

}  // namespace
}  // namespace calib
