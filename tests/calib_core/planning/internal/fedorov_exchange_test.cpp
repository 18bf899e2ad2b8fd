#include "calib_core/planning/internal/fedorov_exchange.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>

#include "calib_core/numerics/condition_number.hpp"
#include "calib_core/planning/internal/condition_number_exchange.hpp"

namespace calib {
namespace {

constexpr int kUnknowns = 6;
constexpr int kCount = 12;
constexpr double kWorthAnything = 1e-9;
const std::vector<GroupBounds> kBounds{{0, 2, 4}, {1, 4, 5}, {2, 3, 6}};

struct Candidates {
  Eigen::MatrixXd rows;
  std::vector<int> groups;
};

/// Three groups with bounds in turn, and a fourth without.
Candidates random_candidates(unsigned seed, int count) {
  std::mt19937_64 chance(seed);
  std::normal_distribution<double> value;
  Candidates candidates{Eigen::MatrixXd(count, kUnknowns), {}};
  for (double& entry : candidates.rows.reshaped()) entry = value(chance);
  candidates.rows.col(0) *= 20.0;  // unknowns of different units
  for (int i = 0; i < count; ++i) candidates.groups.push_back(i % 4);
  return candidates;
}

Eigen::MatrixXd prior() { return 1e-6 * Eigen::MatrixXd::Identity(kUnknowns, kUnknowns); }

Eigen::MatrixXd random_weight(unsigned seed) {
  const Eigen::MatrixXd rows = random_candidates(seed, 3).rows;
  return rows.transpose() * rows;
}

FedorovExchange exchange_over(const Candidates& candidates, bool weighs) {
  FedorovExchange exchange(candidates.rows, candidates.groups, kBounds, prior());
  if (weighs) exchange.set_weight(random_weight(77));
  return exchange;
}

/// Worked out from nothing but the rows.
double figure_of(const Candidates& candidates, const std::vector<std::size_t>& chosen, bool weighs) {
  Eigen::MatrixXd information = prior();
  for (const std::size_t i : chosen) {
    const auto row = candidates.rows.row(static_cast<Eigen::Index>(i));
    information += row.transpose() * row;
  }
  const Eigen::MatrixXd covariance = information.inverse();
  return weighs ? (random_weight(77) * covariance).trace() : std::log(covariance.determinant());
}

bool within_bounds(const Candidates& candidates, const std::vector<std::size_t>& chosen) {
  const bool all_different = std::set(chosen.begin(), chosen.end()).size() == chosen.size();
  std::size_t counted = 0;
  for (const GroupBounds& bounds : kBounds) {
    const auto count =
        std::ranges::count_if(chosen, [&](auto i) { return candidates.groups[i] == bounds.group; });
    if (count < bounds.min || count > bounds.max) return false;
    counted += static_cast<std::size_t>(count);
  }
  return all_different && counted == chosen.size();
}

void improve_fully(FedorovExchange& exchange) {
  for (int round = 0; round < 100 && exchange.improve(kWorthAnything); ++round) {
  }
}

class TouchExchangeBy : public testing::TestWithParam<bool> {
 protected:
  const bool weighs_ = GetParam();
};

INSTANTIATE_TEST_SUITE_P(All, TouchExchangeBy, testing::Bool(),
                         [](const auto& each) { return each.param ? "Trace" : "Determinant"; });

TEST_P(TouchExchangeBy, KeepsTheBoundsOfEveryGroupAsItGrowsImprovesAndShrinks) {
  const Candidates candidates = random_candidates(1, 120);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  exchange.grow(14);
  EXPECT_TRUE(within_bounds(candidates, exchange.chosen()));
  improve_fully(exchange);
  EXPECT_TRUE(within_bounds(candidates, exchange.chosen()));
  exchange.shrink(9);
  EXPECT_EQ(exchange.chosen().size(), 9u);
  EXPECT_TRUE(within_bounds(candidates, exchange.chosen()));
}

TEST_P(TouchExchangeBy, HasTheFigureOfWhatItHasChosen) {
  const Candidates candidates = random_candidates(2, 120);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  exchange.grow(kCount);
  for (int k = 0; k < 40; ++k) {  // back and forth by single steps
    exchange.remove(static_cast<std::size_t>(k) % exchange.chosen().size());
    exchange.add(exchange.best_candidates(3, kCount).back());
    EXPECT_NEAR(exchange.criterion(), figure_of(candidates, exchange.chosen(), weighs_),
                1e-9 * std::abs(exchange.criterion()));
  }
  const Eigen::MatrixXd product = exchange.information() * exchange.covariance();
  EXPECT_TRUE(product.isIdentity(1e-9)) << product;
}

TEST_P(TouchExchangeBy, EndsWhereNoSingleExchangeHelps) {
  const Candidates candidates = random_candidates(3, 80);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  exchange.grow(kCount);
  improve_fully(exchange);
  const double reached = figure_of(candidates, exchange.chosen(), weighs_);
  int tried = 0;
  for (std::size_t place = 0; place < kCount; ++place) {
    for (std::size_t i = 0; i < candidates.groups.size(); ++i) {
      std::vector<std::size_t> other = exchange.chosen();
      other[place] = i;
      if (!within_bounds(candidates, other)) continue;
      ++tried;
      EXPECT_GT(figure_of(candidates, other, weighs_), reached - 1e-6 * std::abs(reached));
    }
  }
  EXPECT_GT(tried, kCount * 20);  // other groups than a touch's own are among them
}

TEST_P(TouchExchangeBy, IsBetterThanEachOfAThousandRandomChoices) {
  const Candidates candidates = random_candidates(4, 120);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  exchange.grow(kCount);
  improve_fully(exchange);
  std::mt19937_64 chance(3);
  std::vector<std::size_t> all(candidates.groups.size());
  std::iota(all.begin(), all.end(), 0u);
  for (int draw = 0; draw < 1000; ++draw) {
    do {
      std::ranges::shuffle(all, chance);
    } while (!within_bounds(candidates, {all.begin(), all.begin() + kCount}));
    EXPECT_LT(exchange.criterion(), figure_of(candidates, {all.begin(), all.begin() + kCount}, weighs_));
  }
}

TEST_P(TouchExchangeBy, ShrinksByWhatIsMissedLeast) {
  const Candidates candidates = random_candidates(5, 120);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  exchange.grow(kCount);
  const std::vector<std::size_t> before = exchange.chosen();
  exchange.shrink(kCount - 1);
  for (std::size_t place = 0; place < before.size(); ++place) {
    std::vector<std::size_t> fewer = before;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(place));
    if (!within_bounds(candidates, fewer)) continue;
    EXPECT_GE(figure_of(candidates, fewer, weighs_),
              exchange.criterion() - 1e-9 * std::abs(exchange.criterion()));
  }
}

TEST_P(TouchExchangeBy, StartsAnewWithWhatItIsGiven) {
  const Candidates candidates = random_candidates(6, 120);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  exchange.grow(kCount);
  const std::vector<std::size_t> chosen = exchange.chosen();
  const double figure = exchange.criterion();
  improve_fully(exchange);
  ASSERT_LT(exchange.criterion(), figure);
  exchange.restart(chosen);
  EXPECT_EQ(exchange.chosen(), chosen);
  EXPECT_NEAR(exchange.criterion(), figure, 1e-9 * std::abs(figure));
}

TEST_P(TouchExchangeBy, RefusesMoreThanTheGroupsHold) {
  const Candidates candidates = random_candidates(7, 120);
  FedorovExchange exchange = exchange_over(candidates, weighs_);
  EXPECT_THROW(exchange.grow(4 + 5 + 6 + 1), std::logic_error);
  exchange.restart({});
  exchange.grow(kCount);
  EXPECT_THROW(exchange.shrink(2 + 4 + 3 - 1), std::logic_error);
}

TEST(ConditionExchange, LowersTheConditionNumberBelowThatOfTheOtherCriteria) {
  const Candidates candidates = random_candidates(8, 400);
  for (const bool weighs : {false, true}) {
    FedorovExchange exchange = exchange_over(candidates, weighs);
    exchange.grow(kCount);
    improve_fully(exchange);
    const double before = condition_number_of_information(exchange.information());
    reduce_condition_number(exchange);
    const double after = condition_number_of_information(exchange.information());
    EXPECT_LT(after, 0.9 * before);
    EXPECT_TRUE(within_bounds(candidates, exchange.chosen()));
    Eigen::MatrixXd taken(kCount, kUnknowns);
    for (Eigen::Index i = 0; i < kCount; ++i) {
      taken.row(i) = exchange.row(exchange.chosen()[static_cast<std::size_t>(i)]).transpose();
    }
    const Eigen::VectorXd sigma = singular_values(taken);
    EXPECT_NEAR(after, sigma[0] / sigma[kUnknowns - 1], 1e-6 * after);
  }
}

}  // namespace
}  // namespace calib
