#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace calib {

/// How many of a group's candidates are wanted; a group is a face.
struct Quota {
  int group = 0;
  int count = 0;
};

/// Candidates whose rows of the observation matrix together tell most: the determinant of the information
/// matrix (D-optimality), columns scaled. First greedily, then by exchange (Fedorov, Theory of Optimal
/// Experiments, 1972). Needs no full rank. `groups` has one entry a row; a group must have enough candidates.
std::vector<std::size_t> select_informative(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                            std::span<const int> groups, std::span<const Quota> quotas);

/// The same candidates with the groups interleaved, in each turn the one that adds most to those before it.
std::vector<std::size_t> order_by_information(const Eigen::Ref<const Eigen::MatrixXd>& rows,
                                              std::span<const int> groups, std::span<const Quota> quotas,
                                              const std::vector<std::size_t>& chosen);

/// Candidates far from each other and, second to that, from the taken ones, by the distance of their columns
/// in `features`, within each group; groups interleaved.
std::vector<std::size_t> select_apart(const Eigen::Ref<const Eigen::MatrixXd>& features,
                                      std::span<const int> groups, std::span<const Quota> quotas,
                                      const std::vector<std::size_t>& taken);

}  // namespace calib
