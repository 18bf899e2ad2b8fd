#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace calib {

/// How many of a group's candidates may be taken; a group is a face.
struct GroupBounds {
  int group = 0;
  int min = 0;
  int max = 0;
};

/// A choice of candidates that is made better and better: which rows of observations to take so that the
/// unknowns are known best. With C the inverse of prior + sum of the taken rows' row^T row, either
/// trace(weight C) is made small, or, without a weight, the determinant of C (D-optimality). What each
/// candidate would add is kept up to date by rank-one steps: taking one or leaving it costs one walk over the
/// candidates, and no memory. `count` below is how many there are to be in the end: it tells which groups
/// must be filled up to their least.
class TouchExchange {
 public:
  /// `rows`: one a candidate, one column an unknown, over the standard deviation of what is observed.
  /// `groups`: one a candidate; one of a group without bounds is never taken. `prior`: the unknowns'
  /// information before any row, positive definite.
  TouchExchange(const Eigen::Ref<const Eigen::MatrixXd>& rows, const std::vector<int>& groups,
                std::vector<GroupBounds> bounds, Eigen::MatrixXd prior);

  /// Judged by trace(weight C) from now on; symmetric, positive semi-definite.
  void weigh(const Eigen::MatrixXd& weight);

  /// Starts anew with these.
  void restart(std::vector<std::size_t> chosen);
  /// Takes the best one at a time until there are `count`. std::logic_error when the groups have too few.
  void grow(int count);
  /// Leaves those that are missed least, one at a time, until there are `count`; groups keep their least.
  void shrink(int count);
  /// Exchanges each of the taken for the best of the others where that makes the figure smaller by more than
  /// this share (of a determinant: its logarithm by more than this). False when none was exchanged.
  bool improve(double worth_it);

  /// Single steps; bounds are the caller's.
  void take(std::size_t candidate);
  void leave(std::size_t place);  // of chosen()
  /// By how much taking the candidate lowers the figure.
  [[nodiscard]] double gain(std::size_t candidate) const;
  /// The best `many` of those that may be taken, best first.
  [[nodiscard]] std::vector<std::size_t> best(std::size_t many, int count) const;

  [[nodiscard]] const std::vector<std::size_t>& chosen() const { return chosen_; }
  /// Of the prior and the taken rows, and its inverse C.
  [[nodiscard]] const Eigen::MatrixXd& information() const { return now_.information; }
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return now_.covariance; }
  /// A candidate's row, as a column.
  [[nodiscard]] auto row(std::size_t candidate) const {
    return rows_.col(static_cast<Eigen::Index>(candidate));
  }
  /// trace(weight C), or the logarithm of C's determinant.
  [[nodiscard]] double figure() const { return now_.figure; }

 private:
  /// All that a step changes.
  struct State {
    Eigen::MatrixXd information, covariance;
    Eigen::VectorXd spread;    // row . C . row of each candidate
    Eigen::VectorXd weighted;  // row . C weight C . row
    double figure = 0.0;
  };

  [[nodiscard]] double loss(std::size_t candidate) const;
  [[nodiscard]] std::vector<bool> open_groups(int count) const;
  [[nodiscard]] std::size_t best_of(const std::vector<bool>& open) const;
  bool exchange_first(double worth_it);  // of chosen(); the one in its place becomes the last
  void count_in(std::size_t candidate);
  void step(std::size_t candidate, double sign);
  void refactor();

  Eigen::MatrixXd rows_;  // a column each
  Eigen::MatrixXd prior_, weight_;
  std::vector<std::size_t> groups_;  // indices into bounds_; their number for those without
  std::vector<GroupBounds> bounds_;
  std::vector<int> counts_;  // taken, one a group
  std::vector<bool> is_taken_;
  std::vector<std::size_t> chosen_;
  State now_, before_;
  Eigen::VectorXd direction_, weighted_direction_, carried_, along_, across_;
  Eigen::MatrixXd block_, weighted_block_;
  int steps_ = 0;  // since all was worked out afresh
};

}  // namespace calib
