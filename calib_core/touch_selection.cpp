#include "calib_core/touch_selection.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace calib {
namespace {

using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

/// Information of no touch at all, in scaled columns: small against that of any touch, enough for an inverse.
constexpr double kRidge = 1e-6;

/// Columns of norm sqrt(rows), so that a row's entries are about 1; columns of zeros stay.
Eigen::MatrixXd scaled(const Matrix& rows) {
  Eigen::VectorXd factors = rows.colwise().norm();
  for (double& factor : factors) {
    factor = factor > 0.0 ? std::sqrt(static_cast<double>(rows.rows())) / factor : 1.0;
  }
  return rows * factors.asDiagonal();
}

/// The inverse of the information matrix, and what each row would add: row . inverse . row.
struct Information {
  Eigen::MatrixXd inverse;
  Eigen::VectorXd gains;

  explicit Information(const Eigen::MatrixXd& rows)
      : inverse(Eigen::MatrixXd::Identity(rows.cols(), rows.cols()) / kRidge),
        gains(rows.rowwise().squaredNorm() / kRidge) {}

  /// sign +1 adds the row, -1 takes it out (Sherman and Morrison).
  void change(const Eigen::MatrixXd& rows, std::size_t index, double sign) {
    const auto row = static_cast<Eigen::Index>(index);
    const Eigen::VectorXd direction = inverse * rows.row(row).transpose();
    const double factor = sign / (1.0 + sign * rows.row(row).dot(direction));
    inverse.noalias() -= factor * direction * direction.transpose();
    gains -= factor * (rows * direction).cwiseAbs2();
  }
};

/// One candidate of each group in turn, as long as its quota lasts; `best` takes it from those of a group.
template <class Best>
std::vector<std::size_t> interleaved(std::span<const int> groups, std::span<const Quota> quotas,
                                     std::vector<bool> eligible, const Best& best) {
  std::vector<std::size_t> order;
  const int rounds = quotas.empty() ? 0 : std::ranges::max(quotas, {}, &Quota::count).count;
  for (int round = 0; round < rounds; ++round) {
    for (const Quota& quota : quotas) {
      if (round >= quota.count) continue;
      std::vector<std::size_t> members;
      for (std::size_t i = 0; i < groups.size(); ++i) {
        if (eligible[i] && groups[i] == quota.group) members.push_back(i);
      }
      if (members.empty()) throw std::logic_error("fewer candidates than the quota of their group");
      const std::size_t taken = best(members);
      eligible[taken] = false;
      order.push_back(taken);
    }
  }
  return order;
}

std::vector<std::size_t> greedy(const Eigen::MatrixXd& rows, std::span<const int> groups,
                                std::span<const Quota> quotas, std::vector<bool> eligible) {
  Information information(rows);
  return interleaved(groups, quotas, std::move(eligible), [&](const std::vector<std::size_t>& members) {
    const std::size_t best = *std::ranges::max_element(
        members, {}, [&](std::size_t i) { return information.gains[static_cast<Eigen::Index>(i)]; });
    information.change(rows, best, 1.0);
    return best;
  });
}

/// One round of exchanges; false when none helped.
bool exchange(const Eigen::MatrixXd& rows, std::span<const int> groups, std::vector<std::size_t>& chosen) {
  constexpr double kWorthIt = 1e-3;  // of the determinant, relative
  Information information(rows);
  std::vector<bool> is_chosen(groups.size(), false);
  for (const std::size_t i : chosen) {
    information.change(rows, i, 1.0);
    is_chosen[i] = true;
  }
  bool changed = false;
  for (std::size_t& place : chosen) {
    information.change(rows, place, -1.0);
    const auto gain = [&](std::size_t i) { return 1.0 + information.gains[static_cast<Eigen::Index>(i)]; };
    std::size_t best = place;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (groups[i] == groups[place] && !is_chosen[i] && gain(i) > gain(best)) best = i;
    }
    if (gain(best) > (1.0 + kWorthIt) * gain(place)) {
      is_chosen[place] = false;
      is_chosen[best] = true;
      place = best;
      changed = true;
    }
    information.change(rows, place, 1.0);
  }
  return changed;
}

/// Being far from each other comes before being far from the taken ones, or the selected would crowd into the
/// places that these left.
constexpr double kFromTakenWeight = 2.0;

}  // namespace

std::vector<std::size_t> select_informative(const Matrix& rows, std::span<const int> groups,
                                            std::span<const Quota> quotas) {
  constexpr int kRoundsMax = 8;
  const Eigen::MatrixXd scaled_rows = scaled(rows);
  std::vector<std::size_t> chosen =
      greedy(scaled_rows, groups, quotas, std::vector<bool>(groups.size(), true));
  for (int round = 0; round < kRoundsMax && exchange(scaled_rows, groups, chosen); ++round) {
  }
  return chosen;
}

std::vector<std::size_t> order_by_information(const Matrix& rows, std::span<const int> groups,
                                              std::span<const Quota> quotas,
                                              const std::vector<std::size_t>& chosen) {
  std::vector<bool> eligible(groups.size(), false);
  for (const std::size_t i : chosen) eligible[i] = true;
  return greedy(scaled(rows), groups, quotas, std::move(eligible));
}

std::vector<std::size_t> select_apart(const Matrix& features, std::span<const int> groups,
                                      std::span<const Quota> quotas, const std::vector<std::size_t>& taken) {
  std::vector<bool> eligible(groups.size(), true);
  Eigen::VectorXd nearest = Eigen::VectorXd::Constant(features.cols(), std::numeric_limits<double>::max());
  const auto take = [&](std::size_t index, double weight) {
    const auto column = static_cast<Eigen::Index>(index);
    for (Eigen::Index i = 0; i < features.cols(); ++i) {
      if (groups[static_cast<std::size_t>(i)] != groups[index]) continue;
      nearest[i] = std::min(nearest[i], weight * (features.col(i) - features.col(column)).norm());
    }
  };
  for (const std::size_t i : taken) {
    eligible[i] = false;
    take(i, kFromTakenWeight);
  }
  return interleaved(groups, quotas, std::move(eligible), [&](const std::vector<std::size_t>& members) {
    const std::size_t farthest = *std::ranges::max_element(
        members, {}, [&](std::size_t i) { return nearest[static_cast<Eigen::Index>(i)]; });
    take(farthest, 1.0);
    return farthest;
  });
}

}  // namespace calib
