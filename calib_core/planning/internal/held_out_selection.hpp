#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace calib {

/// The wanted number of candidates of a group; a group is a face.
struct Quota {
  int group = 0;
  int count = 0;
};

/// Farthest point sampling: within each group, candidates far from each other and, with less weight, from the
/// taken ones, by the distance of their columns in `features`; groups alternate. `groups` has one entry per
/// candidate. Throws std::logic_error when a group has too few.
std::vector<std::size_t> farthest_point_sampling(const Eigen::Ref<const Eigen::MatrixXd>& features,
                                                 std::span<const int> groups, std::span<const Quota> quotas,
                                                 const std::vector<std::size_t>& taken);

}  // namespace calib
