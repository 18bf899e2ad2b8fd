#include "calib_core/planning/internal/held_out_selection.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace calib {
namespace {

using Matrix = Eigen::Ref<const Eigen::MatrixXd>;

/// Distances from the taken candidates count more, so that distances between the selected ones decide.
/// Otherwise these would crowd into the gaps between the taken ones.
constexpr double kFromTakenWeight = 2.0;

/// Distance of each candidate from the nearest taken one of its group.
class FeatureDistances {
 public:
  FeatureDistances(const Matrix& features, std::span<const int> groups)
      : features_(features),
        groups_(groups),
        is_taken_(groups.size(), false),
        nearest_(groups.size(), std::numeric_limits<double>::max()) {}

  void take(std::size_t taken, double weight) {
    is_taken_[taken] = true;
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (groups_[i] == groups_[taken]) nearest_[i] = std::min(nearest_[i], weight * distance(i, taken));
    }
  }
  [[nodiscard]] std::size_t farthest(int group) const {
    std::size_t farthest = groups_.size();
    for (std::size_t i = 0; i < groups_.size(); ++i) {
      if (groups_[i] != group || is_taken_[i]) continue;
      if (farthest == groups_.size() || nearest_[i] > nearest_[farthest]) farthest = i;
    }
    if (farthest == groups_.size()) throw std::logic_error("fewer candidates than the quota of their group");
    return farthest;
  }

 private:
  [[nodiscard]] double distance(std::size_t a, std::size_t b) const {
    return (features_.col(static_cast<Eigen::Index>(a)) - features_.col(static_cast<Eigen::Index>(b))).norm();
  }

  const Matrix& features_;
  std::span<const int> groups_;
  std::vector<bool> is_taken_;
  std::vector<double> nearest_;
};

}  // namespace

std::vector<std::size_t> farthest_point_sampling(const Matrix& features, std::span<const int> groups,
                                                 std::span<const Quota> quotas,
                                                 const std::vector<std::size_t>& taken) {
  FeatureDistances distances(features, groups);
  for (const std::size_t i : taken) distances.take(i, kFromTakenWeight);
  std::vector<std::size_t> selected;
  const int rounds = quotas.empty() ? 0 : std::ranges::max(quotas, {}, &Quota::count).count;
  for (int round = 0; round < rounds; ++round) {
    for (const Quota& quota : quotas) {
      if (round >= quota.count) continue;
      selected.push_back(distances.farthest(quota.group));
      distances.take(selected.back(), 1.0);
    }
  }
  return selected;
}

}  // namespace calib
