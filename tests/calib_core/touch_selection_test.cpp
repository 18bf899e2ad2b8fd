#include "calib_core/touch_selection.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace calib {
namespace {

struct Candidates {
  Eigen::MatrixXd rows;
  std::vector<int> groups;
};

/// Three groups in turn; one column repeats another, so the rank is one less than the columns.
Candidates random_candidates(unsigned seed, int count) {
  std::mt19937_64 chance(seed);
  std::normal_distribution<double> value;
  Candidates candidates{Eigen::MatrixXd(count, 7), {}};
  for (double& entry : candidates.rows.reshaped()) entry = value(chance);
  candidates.rows.col(6) = 2.0 * candidates.rows.col(1);
  for (int i = 0; i < count; ++i) candidates.groups.push_back(i % 3);
  return candidates;
}

double log_determinant(const Eigen::MatrixXd& rows, const std::vector<std::size_t>& chosen) {
  Eigen::MatrixXd kept(static_cast<Eigen::Index>(chosen.size()), 6);  // without the repeated column
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    kept.row(static_cast<Eigen::Index>(i)) = rows.row(static_cast<Eigen::Index>(chosen[i])).head<6>();
  }
  return std::log((kept.transpose() * kept).determinant());
}

const std::vector<Quota> kQuotas{{0, 4}, {1, 3}, {2, 5}};

TEST(TouchSelection, TakesAsManyDifferentCandidatesOfEachGroupAsWanted) {
  const Candidates candidates = random_candidates(1, 90);
  const auto chosen = select_informative(candidates.rows, candidates.groups, kQuotas);
  EXPECT_EQ(std::set(chosen.begin(), chosen.end()).size(), 12u);
  for (const Quota& quota : kQuotas) {
    EXPECT_EQ(std::ranges::count_if(chosen, [&](auto i) { return candidates.groups[i] == quota.group; }),
              quota.count);
  }
}

TEST(TouchSelection, TellsMoreThanEachOfAThousandRandomChoices) {
  const Candidates candidates = random_candidates(2, 90);
  const double selected =
      log_determinant(candidates.rows, select_informative(candidates.rows, candidates.groups, kQuotas));
  std::mt19937_64 chance(3);
  std::vector<std::size_t> all(candidates.groups.size());
  std::iota(all.begin(), all.end(), 0u);
  for (int draw = 0; draw < 1000; ++draw) {
    std::ranges::shuffle(all, chance);
    std::vector<std::size_t> random;
    for (const Quota& quota : kQuotas) {
      int left = quota.count;
      for (const std::size_t i : all) {
        if (candidates.groups[i] == quota.group && left-- > 0) random.push_back(i);
      }
    }
    EXPECT_LT(log_determinant(candidates.rows, random), selected) << draw;
  }
}

TEST(TouchSelection, NoExchangeWithAnotherCandidateOfTheGroupHelps) {
  const Candidates candidates = random_candidates(4, 45);
  const auto chosen = select_informative(candidates.rows, candidates.groups, kQuotas);
  const double selected = log_determinant(candidates.rows, chosen);
  for (std::size_t place = 0; place < chosen.size(); ++place) {
    for (std::size_t i = 0; i < candidates.groups.size(); ++i) {
      if (candidates.groups[i] != candidates.groups[chosen[place]] || std::ranges::count(chosen, i)) continue;
      auto exchanged = chosen;
      exchanged[place] = i;
      EXPECT_LT(log_determinant(candidates.rows, exchanged), selected + 2e-3);
    }
  }
}

TEST(TouchSelection, OrderInterleavesTheGroupsAndShowsAllColumnsFirst) {
  const Candidates candidates = random_candidates(5, 90);
  const auto chosen = select_informative(candidates.rows, candidates.groups, kQuotas);
  const auto order = order_by_information(candidates.rows, candidates.groups, kQuotas, chosen);
  std::vector<int> groups;
  for (const std::size_t i : order) groups.push_back(candidates.groups[i]);
  EXPECT_EQ(groups, (std::vector{0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 2, 2}));
  EXPECT_EQ(std::set(order.begin(), order.end()), std::set(chosen.begin(), chosen.end()));
  const std::vector<std::size_t> first(order.begin(), order.begin() + 6);
  EXPECT_GT(log_determinant(candidates.rows, first), std::log(1e-3));
}

TEST(TouchSelection, ApartIsFarFromEachOtherAndThenFromTheTaken) {
  const Eigen::MatrixXd features = (Eigen::MatrixXd(1, 7) << 0, 1, 4, 9, 10, 2.5, 30).finished();
  const std::vector<int> groups{0, 0, 0, 0, 0, 0, 1};
  const std::vector<Quota> quotas{{0, 3}};
  EXPECT_EQ(select_apart(features, groups, quotas, {0}), (std::vector<std::size_t>{4, 2, 1}));
}

TEST(TouchSelection, RefusesAGroupWithTooFewCandidates) {
  const Candidates candidates = random_candidates(6, 9);
  const std::vector<Quota> quotas{{1, 4}};
  EXPECT_THROW(select_informative(candidates.rows, candidates.groups, quotas), std::logic_error);
}

}  // namespace
}  // namespace calib
