#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace calib {

/// How many candidates of a group may be chosen; a group is a face.
struct GroupBounds {
  int group = 0;
  int min = 0;
  int max = 0;
};

/// Optimal experimental design by exchange of single candidates (Fedorov, Theory of Optimal Experiments,
/// 1972): which observations to make so that the unknowns are known best. With C the inverse of prior + sum
/// of row^T row over the chosen rows, it minimises trace(weight C), or without a weight the determinant of C
/// (D-optimality). The gain of every candidate is updated by rank-one steps: adding or removing one costs one
/// pass over the candidates and allocates no memory. The parameter `count` is the final number of chosen
/// candidates, from which follows which groups still have to reach their minimum.
class FedorovExchange {
 public:
  /// `rows`: one per candidate, one column per unknown, divided by the standard deviation of the observation.
  /// `groups`: one per candidate; candidates of a group without bounds are never chosen. `prior`: information
  /// on the unknowns without observations, positive definite.
  FedorovExchange(const Eigen::Ref<const Eigen::MatrixXd>& rows, const std::vector<int>& groups,
                  std::vector<GroupBounds> bounds, Eigen::MatrixXd prior);

  /// Changes the criterion to trace(weight C); symmetric, positive semi-definite.
  void set_weight(const Eigen::MatrixXd& weight);

  /// Replaces the chosen candidates.
  void restart(std::vector<std::size_t> chosen);
  /// Adds the best candidate until there are `count`. Throws std::logic_error when the groups have too few.
  void grow(int count);
  /// Removes the least important candidate until there are `count`; groups keep their minimum.
  void shrink(int count);
  /// Exchanges each chosen candidate for the best other one where that reduces the criterion by more than
  /// this fraction (determinant: its logarithm by more than this). False when none was exchanged.
  bool improve(double improvement_min);

  /// Single steps; bounds are not checked.
  void add(std::size_t candidate);
  void remove(std::size_t place);  // index into chosen()
  /// Reduction of the criterion by adding the candidate.
  [[nodiscard]] double gain(std::size_t candidate) const;
  /// The best `many` candidates that may be added, best first.
  [[nodiscard]] std::vector<std::size_t> best_candidates(std::size_t many, int count) const;

  [[nodiscard]] const std::vector<std::size_t>& chosen() const { return chosen_; }
  /// Information of the prior and the chosen rows, and its inverse C.
  [[nodiscard]] const Eigen::MatrixXd& information() const { return now_.information; }
  [[nodiscard]] const Eigen::MatrixXd& covariance() const { return now_.covariance; }
  /// A candidate's row, as a column.
  [[nodiscard]] auto row(std::size_t candidate) const {
    return rows_.col(static_cast<Eigen::Index>(candidate));
  }
  /// trace(weight C), or the logarithm of C's determinant.
  [[nodiscard]] double criterion() const { return now_.criterion; }

 private:
  /// Everything that a step changes.
  struct State {
    Eigen::MatrixXd information, covariance;
    Eigen::VectorXd spread;    // row . C . row of each candidate
    Eigen::VectorXd weighted;  // row . C weight C . row
    double criterion = 0.0;
  };

  struct Buffers {
    Eigen::VectorXd direction, weighted_direction, carried, along, across;
    Eigen::MatrixXd block, weighted_block;
  };

  [[nodiscard]] double loss(std::size_t candidate) const;
  [[nodiscard]] std::vector<bool> open_groups(int count) const;
  [[nodiscard]] std::size_t best_of(const std::vector<bool>& open) const;
  bool try_exchange_first(double improvement_min);  // an exchanged candidate moves to the end of chosen()
  void mark_chosen(std::size_t candidate);
  void step(std::size_t candidate, double sign);
  void recompute();

  Eigen::MatrixXd rows_;  // one column per candidate
  Eigen::MatrixXd prior_, weight_;
  std::vector<std::size_t> groups_;  // indices into bounds_; bounds_.size() for a group without bounds
  std::vector<GroupBounds> bounds_;
  std::vector<int> counts_;  // chosen, one per group
  std::vector<bool> is_chosen_;
  std::vector<std::size_t> chosen_;
  State now_, before_;
  Buffers buffers_;
  int steps_ = 0;  // since recompute()
};

}  // namespace calib
