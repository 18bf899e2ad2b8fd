#include "calib_core/planning/internal/fedorov_exchange.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "calib_core/numerics/scaled_cholesky.hpp"

namespace calib {
namespace {

/// Steps after which the accumulated rounding errors are removed.
constexpr int kExchangesMax = 200;

/// A row that provides all information in some direction up to this fraction is not removed: the result would
/// be too inaccurate.
constexpr double kIndispensable = 1e-7;

/// Candidates per block, so that intermediate results stay in the cache.
constexpr Eigen::Index kBlock = 256;

}  // namespace

FedorovExchange::FedorovExchange(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                 const std::vector<int>& groups, std::vector<GroupBounds> bounds,
                                 Eigen::MatrixXd prior)
    : rows_(rows.transpose()),
      prior_(std::move(prior)),
      bounds_(std::move(bounds)),
      counts_(bounds_.size(), 0),
      is_chosen_(groups.size(), false),
      buffers_{.along = Eigen::VectorXd(kBlock),
               .across = Eigen::VectorXd(kBlock),
               .block = Eigen::MatrixXd(rows_.rows(), kBlock),
               .weighted_block = Eigen::MatrixXd(rows_.rows(), kBlock)} {
  for (const int group : groups) {
    const auto found = std::ranges::find(bounds_, group, &GroupBounds::group);
    groups_.push_back(static_cast<std::size_t>(found - bounds_.begin()));
  }
  now_.spread.resize(rows_.cols());
  now_.weighted.setZero(rows_.cols());
  recompute();
  before_ = now_;
}

void FedorovExchange::set_weight(const Eigen::MatrixXd& weight) {
  weight_ = weight;
  recompute();
}

void FedorovExchange::restart(std::vector<std::size_t> chosen) {
  is_chosen_.assign(is_chosen_.size(), false);
  std::ranges::fill(counts_, 0);
  chosen_.clear();
  for (const std::size_t candidate : chosen) mark_chosen(candidate);
  recompute();
}

double FedorovExchange::gain(std::size_t candidate) const {
  const auto i = static_cast<Eigen::Index>(candidate);
  return weight_.size() == 0 ? std::log1p(now_.spread[i]) : now_.weighted[i] / (1.0 + now_.spread[i]);
}

double FedorovExchange::loss(std::size_t candidate) const {
  const auto i = static_cast<Eigen::Index>(candidate);
  const double left = std::max(1.0 - now_.spread[i], kIndispensable);
  return weight_.size() == 0 ? -std::log(left) : now_.weighted[i] / left;
}

std::vector<bool> FedorovExchange::open_groups(int count) const {
  int missing = 0;
  for (std::size_t g = 0; g < bounds_.size(); ++g) missing += std::max(0, bounds_[g].min - counts_[g]);
  const bool any = count - static_cast<int>(chosen_.size()) > missing;
  std::vector<bool> open(bounds_.size() + 1, false);
  for (std::size_t g = 0; g < bounds_.size(); ++g) {
    open[g] = counts_[g] < bounds_[g].min || (any && counts_[g] < bounds_[g].max);
  }
  return open;
}

std::size_t FedorovExchange::best_of(const std::vector<bool>& open) const {
  std::size_t best = groups_.size();
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (open[groups_[i]] && !is_chosen_[i] && (best == groups_.size() || gain(i) > gain(best))) best = i;
  }
  return best;
}

std::vector<std::size_t> FedorovExchange::best_candidates(std::size_t many, int count) const {
  const std::vector<bool> open = open_groups(count);
  std::vector<std::size_t> eligible;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (open[groups_[i]] && !is_chosen_[i]) eligible.push_back(i);
  }
  const std::size_t kept = std::min(many, eligible.size());
  std::ranges::partial_sort(eligible, eligible.begin() + static_cast<std::ptrdiff_t>(kept),
                            std::ranges::greater{}, [&](std::size_t i) { return gain(i); });
  eligible.resize(kept);
  return eligible;
}

/// Sherman-Morrison: C decreases by factor * direction direction^T, direction = C row. The rest follows.
void FedorovExchange::step(std::size_t candidate, double sign) {
  const auto row = rows_.col(static_cast<Eigen::Index>(candidate));
  buffers_.direction.noalias() = now_.covariance * row;
  const double factor = sign / (1.0 + sign * row.dot(buffers_.direction));
  double square = 0.0;  // direction . weight . direction
  if (weight_.size() == 0) {
    now_.criterion += std::log(sign * factor);
  } else {
    buffers_.weighted_direction.noalias() = weight_ * buffers_.direction;
    buffers_.carried.noalias() = now_.covariance * buffers_.weighted_direction;
    square = buffers_.direction.dot(buffers_.weighted_direction);
    now_.criterion -= factor * square;
  }
  for (Eigen::Index begin = 0; begin < rows_.cols(); begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, rows_.cols() - begin);
    const auto block = rows_.middleCols(begin, size);
    auto along = buffers_.along.head(size);
    along.noalias() = block.transpose() * buffers_.direction;
    if (weight_.size() != 0) {
      auto across = buffers_.across.head(size);
      across.noalias() = block.transpose() * buffers_.carried;
      now_.weighted.segment(begin, size).array() +=
          factor * along.array() * (factor * square * along.array() - 2.0 * across.array());
    }
    now_.spread.segment(begin, size).array() -= factor * along.array().square();
  }
  now_.covariance.noalias() -= factor * buffers_.direction * buffers_.direction.transpose();
  now_.information.noalias() += sign * row * row.transpose();
  ++steps_;
}

void FedorovExchange::recompute() {
  now_.information = prior_;
  for (const std::size_t candidate : chosen_) {
    now_.information.noalias() += row(candidate) * row(candidate).transpose();
  }
  const ScaledCholesky cholesky(now_.information);
  if (!cholesky.is_positive_definite()) throw std::logic_error("the prior leaves an unknown undetermined");
  now_.covariance = cholesky.inverse();
  const bool weighs = weight_.size() != 0;
  now_.criterion = weighs ? weight_.cwiseProduct(now_.covariance).sum() : cholesky.inverse_log_determinant();
  for (Eigen::Index begin = 0; begin < rows_.cols(); begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, rows_.cols() - begin);
    auto carried = buffers_.block.leftCols(size);
    carried.noalias() = now_.covariance * rows_.middleCols(begin, size);
    now_.spread.segment(begin, size) =
        carried.cwiseProduct(rows_.middleCols(begin, size)).colwise().sum().transpose();
    if (!weighs) continue;
    auto weighted = buffers_.weighted_block.leftCols(size);
    weighted.noalias() = weight_ * carried;
    now_.weighted.segment(begin, size) = carried.cwiseProduct(weighted).colwise().sum().transpose();
  }
  steps_ = 0;
}

void FedorovExchange::mark_chosen(std::size_t candidate) {
  chosen_.push_back(candidate);
  is_chosen_[candidate] = true;
  ++counts_[groups_[candidate]];
}

void FedorovExchange::add(std::size_t candidate) {
  step(candidate, 1.0);
  mark_chosen(candidate);
}

void FedorovExchange::remove(std::size_t place) {
  const std::size_t candidate = chosen_[place];
  step(candidate, -1.0);
  chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(place));
  is_chosen_[candidate] = false;
  --counts_[groups_[candidate]];
}

void FedorovExchange::grow(int count) {
  while (static_cast<int>(chosen_.size()) < count) {
    const std::size_t best = best_of(open_groups(count));
    if (best == groups_.size()) throw std::logic_error("fewer candidates than are to be taken");
    add(best);
  }
  recompute();
}

void FedorovExchange::shrink(int count) {
  while (static_cast<int>(chosen_.size()) > count) {
    std::size_t least = chosen_.size();
    for (std::size_t place = 0; place < chosen_.size(); ++place) {
      const std::size_t group = groups_[chosen_[place]];
      if (counts_[group] <= bounds_[group].min) continue;
      if (least == chosen_.size() || loss(chosen_[place]) < loss(chosen_[least])) least = place;
    }
    if (least == chosen_.size()) throw std::logic_error("more candidates than may be taken are asked for");
    remove(least);
  }
  recompute();
}

bool FedorovExchange::try_exchange_first(double improvement_min) {
  const std::size_t old = chosen_.front();
  const auto count = static_cast<int>(chosen_.size());
  if (1.0 - now_.spread[static_cast<Eigen::Index>(old)] < kIndispensable) {
    std::ranges::rotate(chosen_, chosen_.begin() + 1);
    return false;
  }
  const double least_gain = weight_.size() == 0 ? improvement_min : improvement_min * now_.criterion;
  before_ = now_;
  remove(0);
  const std::size_t best = best_of(open_groups(count));
  const bool is_better = gain(best) > gain(old) + least_gain;
  if (is_better) {
    add(best);
  } else {
    now_ = before_;
    mark_chosen(old);
  }
  return is_better;
}

bool FedorovExchange::improve(double improvement_min) {
  bool changed = false;
  for (std::size_t turn = 0; turn < chosen_.size(); ++turn) {
    if (try_exchange_first(improvement_min)) changed = true;
    if (steps_ > kExchangesMax) recompute();
  }
  return changed;
}

}  // namespace calib
