#include "calib_core/planning/internal/held_out_selection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <stdexcept>

namespace calib {
namespace {

const Eigen::MatrixXd kFeatures = (Eigen::MatrixXd(1, 8) << 0, 1, 4, 9, 10, 2.5, 30, 31).finished();
const std::vector<int> kGroups{0, 0, 0, 0, 0, 0, 1, 1};

TEST(TouchSelection, ApartIsFarFromEachOtherAndThenFromTheTaken) {
  const std::vector<Quota> quotas{{0, 3}};
  EXPECT_EQ(farthest_point_sampling(kFeatures, kGroups, quotas, {0}), (std::vector<std::size_t>{4, 2, 1}));
}

TEST(TouchSelection, TakesTheGroupsInTurnAndEachAsOftenAsWanted) {
  const std::vector<Quota> quotas{{0, 3}, {1, 1}};
  std::vector<int> groups;
  for (const std::size_t i : farthest_point_sampling(kFeatures, kGroups, quotas, {0}))
    groups.push_back(kGroups[i]);
  EXPECT_EQ(groups, (std::vector{0, 1, 0, 0}));
}

TEST(TouchSelection, RefusesAGroupWithTooFewCandidates) {
  const std::vector<Quota> quotas{{1, 2}};
  EXPECT_EQ(farthest_point_sampling(kFeatures, kGroups, quotas, {}).size(), 2u);
  EXPECT_THROW(farthest_point_sampling(kFeatures, kGroups, quotas, {6}), std::logic_error);
}

}  // namespace
}  // namespace calib
