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

TEST(Identifiability, NamesTheLeadingColumnsThatAbsorbACandidate) {
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(6, kErrorParameterCount);
  w(0, 0) = 1.0;
  w(0, 1) = 2.0;
  w(1, 1) = 6.0;  // twice column 0 and three times the second leading column that is kept
  Eigen::MatrixXd leading = Eigen::MatrixXd::Zero(6, 3);
  leading(2, 0) = 1.0;
  leading(2, 1) = 5.0;  // depends on the first
  leading(1, 2) = 2.0;
  const IdentifiableSet set = choose_identifiable(w, {}, {}, leading);
  EXPECT_THAT(set.columns, ElementsAre(0));
  EXPECT_EQ(set.candidates[1].status, ParameterStatus::kGrouped);
  EXPECT_THAT(set.candidates[1].grouped_with, ElementsAre(Pair(0, ::testing::DoubleNear(2.0, 1e-12))));
  EXPECT_THAT(set.candidates[1].grouped_with_leading,
              ElementsAre(Pair(2, ::testing::DoubleNear(3.0, 1e-12))));
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
