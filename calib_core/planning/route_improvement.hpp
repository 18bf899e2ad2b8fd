#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace calib {

/// What a way through stops costs.
struct WayProblem {
  Eigen::Ref<const Eigen::MatrixXd> seconds;  // from row to column, symmetric
  std::span<const int> faces;                 // of each stop; -1 for the park posture
};

/// `order` with the stops from `begin` to `end` in a shorter order: exchanges of two stops, reversals of a
/// piece (2-opt) and moves of up to three stops to another place (Or-opt) as long as one shortens the way and
/// the faces of the stops from `counted_from` to `end` stay interleaved as they are. The stops around are
/// kept.
void shorten_way(const WayProblem& problem, std::vector<std::size_t>& order, std::size_t counted_from,
                 std::size_t begin, std::size_t end);

double way_s(const WayProblem& problem, std::span<const std::size_t> order);

}  // namespace calib
