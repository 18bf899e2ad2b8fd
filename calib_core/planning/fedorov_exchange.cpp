#include "calib_core/planning/internal/fedorov_exchange.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace calib {
namespace {

/// Steps after which rounding is swept out.
constexpr int kStepsMax = 200;

/// A row whose share of the information that it meets is this near to all of it cannot be left: too few
/// digits would remain.
constexpr double kIndispensable = 1e-7;

/// Candidates walked over at a time, so that what is worked out of them stays in the cache.
constexpr Eigen::Index kBlock = 256;

}  // namespace

TouchExchange::TouchExchange(const Eigen::Ref<const Eigen::MatrixXd>& rows, const std::vector<int>& groups,
                             std::vector<GroupBounds> bounds, Eigen::MatrixXd prior)
    : rows_(rows.transpose()),
      prior_(std::move(prior)),
      bounds_(std::move(bounds)),
      counts_(bounds_.size(), 0),
      is_taken_(groups.size(), false),
      along_(kBlock),
      across_(kBlock),
      block_(rows_.rows(), kBlock),
      weighted_block_(rows_.rows(), kBlock) {
  for (const int group : groups) {
    const auto found = std::ranges::find(bounds_, group, &GroupBounds::group);
    groups_.push_back(static_cast<std::size_t>(found - bounds_.begin()));
  }
  now_.spread.resize(rows_.cols());
  now_.weighted.setZero(rows_.cols());
  refactor();
  before_ = now_;
}

void TouchExchange::weigh(const Eigen::MatrixXd& weight) {
  weight_ = weight;
  refactor();
}

void TouchExchange::restart(std::vector<std::size_t> chosen) {
  is_taken_.assign(is_taken_.size(), false);
  std::ranges::fill(counts_, 0);
  chosen_.clear();
  for (const std::size_t candidate : chosen) count_in(candidate);
  refactor();
}

double TouchExchange::gain(std::size_t candidate) const {
  const auto i = static_cast<Eigen::Index>(candidate);
  return weight_.size() == 0 ? std::log1p(now_.spread[i]) : now_.weighted[i] / (1.0 + now_.spread[i]);
}

double TouchExchange::loss(std::size_t candidate) const {
  const auto i = static_cast<Eigen::Index>(candidate);
  const double left = std::max(1.0 - now_.spread[i], kIndispensable);
  return weight_.size() == 0 ? -std::log(left) : now_.weighted[i] / left;
}

std::vector<bool> TouchExchange::open_groups(int count) const {
  int missing = 0;
  for (std::size_t g = 0; g < bounds_.size(); ++g) missing += std::max(0, bounds_[g].min - counts_[g]);
  const bool any = count - static_cast<int>(chosen_.size()) > missing;
  std::vector<bool> open(bounds_.size() + 1, false);
  for (std::size_t g = 0; g < bounds_.size(); ++g) {
    open[g] = counts_[g] < bounds_[g].min || (any && counts_[g] < bounds_[g].max);
  }
  return open;
}

std::size_t TouchExchange::best_of(const std::vector<bool>& open) const {
  std::size_t best = groups_.size();
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (open[groups_[i]] && !is_taken_[i] && (best == groups_.size() || gain(i) > gain(best))) best = i;
  }
  return best;
}

std::vector<std::size_t> TouchExchange::best(std::size_t many, int count) const {
  const std::vector<bool> open = open_groups(count);
  std::vector<std::size_t> eligible;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (open[groups_[i]] && !is_taken_[i]) eligible.push_back(i);
  }
  const std::size_t kept = std::min(many, eligible.size());
  std::ranges::partial_sort(eligible, eligible.begin() + static_cast<std::ptrdiff_t>(kept),
                            std::ranges::greater{}, [&](std::size_t i) { return gain(i); });
  eligible.resize(kept);
  return eligible;
}

/// Sherman and Morrison: C loses factor * direction direction^T, direction = C row. All else follows.
void TouchExchange::step(std::size_t candidate, double sign) {
  const auto row = rows_.col(static_cast<Eigen::Index>(candidate));
  direction_.noalias() = now_.covariance * row;
  const double factor = sign / (1.0 + sign * row.dot(direction_));
  double square = 0.0;  // direction . weight . direction
  if (weight_.size() == 0) {
    now_.figure += std::log(sign * factor);
  } else {
    weighted_direction_.noalias() = weight_ * direction_;
    carried_.noalias() = now_.covariance * weighted_direction_;
    square = direction_.dot(weighted_direction_);
    now_.figure -= factor * square;
  }
  for (Eigen::Index begin = 0; begin < rows_.cols(); begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, rows_.cols() - begin);
    const auto block = rows_.middleCols(begin, size);
    auto along = along_.head(size);
    along.noalias() = block.transpose() * direction_;
    if (weight_.size() != 0) {
      auto across = across_.head(size);
      across.noalias() = block.transpose() * carried_;
      now_.weighted.segment(begin, size).array() +=
          factor * along.array() * (factor * square * along.array() - 2.0 * across.array());
    }
    now_.spread.segment(begin, size).array() -= factor * along.array().square();
  }
  now_.covariance.noalias() -= factor * direction_ * direction_.transpose();
  now_.information.noalias() += sign * row * row.transpose();
  ++steps_;
}

void TouchExchange::refactor() {
  now_.information = prior_;
  for (const std::size_t candidate : chosen_) {
    now_.information.noalias() += row(candidate) * row(candidate).transpose();
  }
  // Unknowns of different units: columns of unit diagonal keep the digits.
  const Eigen::VectorXd scale = now_.information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> cholesky(scale.asDiagonal() * now_.information * scale.asDiagonal());
  if (cholesky.info() != Eigen::Success) throw std::logic_error("the prior leaves an unknown undetermined");
  now_.covariance = scale.asDiagonal() *
                    cholesky.solve(Eigen::MatrixXd::Identity(prior_.rows(), prior_.rows())) *
                    scale.asDiagonal();
  const bool weighs = weight_.size() != 0;
  if (weighs) {
    now_.figure = weight_.cwiseProduct(now_.covariance).sum();
  } else {
    const Eigen::MatrixXd& factor = cholesky.matrixLLT();
    now_.figure = 2.0 * (scale.array().log().sum() - factor.diagonal().array().log().sum());
  }
  for (Eigen::Index begin = 0; begin < rows_.cols(); begin += kBlock) {
    const Eigen::Index size = std::min(kBlock, rows_.cols() - begin);
    auto carried = block_.leftCols(size);
    carried.noalias() = now_.covariance * rows_.middleCols(begin, size);
    now_.spread.segment(begin, size) =
        carried.cwiseProduct(rows_.middleCols(begin, size)).colwise().sum().transpose();
    if (!weighs) continue;
    auto weighted = weighted_block_.leftCols(size);
    weighted.noalias() = weight_ * carried;
    now_.weighted.segment(begin, size) = carried.cwiseProduct(weighted).colwise().sum().transpose();
  }
  steps_ = 0;
}

void TouchExchange::count_in(std::size_t candidate) {
  chosen_.push_back(candidate);
  is_taken_[candidate] = true;
  ++counts_[groups_[candidate]];
}

void TouchExchange::take(std::size_t candidate) {
  step(candidate, 1.0);
  count_in(candidate);
}

void TouchExchange::leave(std::size_t place) {
  const std::size_t candidate = chosen_[place];
  step(candidate, -1.0);
  chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(place));
  is_taken_[candidate] = false;
  --counts_[groups_[candidate]];
}

void TouchExchange::grow(int count) {
  while (static_cast<int>(chosen_.size()) < count) {
    const std::size_t best = best_of(open_groups(count));
    if (best == groups_.size()) throw std::logic_error("fewer candidates than are to be taken");
    take(best);
  }
  refactor();
}

void TouchExchange::shrink(int count) {
  while (static_cast<int>(chosen_.size()) > count) {
    std::size_t least = chosen_.size();
    for (std::size_t place = 0; place < chosen_.size(); ++place) {
      const std::size_t group = groups_[chosen_[place]];
      if (counts_[group] <= bounds_[group].min) continue;
      if (least == chosen_.size() || loss(chosen_[place]) < loss(chosen_[least])) least = place;
    }
    if (least == chosen_.size()) throw std::logic_error("more candidates than may be taken are asked for");
    leave(least);
  }
  refactor();
}

bool TouchExchange::exchange_first(double worth_it) {
  const std::size_t old = chosen_.front();
  const auto count = static_cast<int>(chosen_.size());
  if (1.0 - now_.spread[static_cast<Eigen::Index>(old)] < kIndispensable) {
    std::ranges::rotate(chosen_, chosen_.begin() + 1);
    return false;
  }
  const double least_gain = weight_.size() == 0 ? worth_it : worth_it * now_.figure;
  before_ = now_;
  leave(0);
  const std::size_t best = best_of(open_groups(count));
  const bool is_worth_it = gain(best) > gain(old) + least_gain;
  if (is_worth_it) {
    take(best);
  } else {
    now_ = before_;
    count_in(old);
  }
  return is_worth_it;
}

bool TouchExchange::improve(double worth_it) {
  bool changed = false;
  for (std::size_t turn = 0; turn < chosen_.size(); ++turn) {
    if (exchange_first(worth_it)) changed = true;
    if (steps_ > kStepsMax) refactor();
  }
  return changed;
}

}  // namespace calib
