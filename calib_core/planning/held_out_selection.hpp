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

/// Candidates far from each other and, second to that, from the taken ones, by the distance of their columns
/// in `features`, within each group; groups interleaved. `groups` has one entry a candidate; too few of a
/// group: std::logic_error.
std::vector<std::size_t> select_apart(const Eigen::Ref<const Eigen::MatrixXd>& features,
                                      std::span<const int> groups, std::span<const Quota> quotas,
                                      const std::vector<std::size_t>& taken);

}  // namespace calib
