#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

namespace calib {

/// Travel times between the stops of a route.
struct RouteProblem {
  Eigen::Ref<const Eigen::MatrixXd> seconds;  // from row to column, symmetric
  std::span<const int> faces;                 // one per stop; -1 for the park posture
};

/// Reorders the stops from `begin` to `end` to reduce the travel time, by exchanging two stops, reversing a
/// section (2-opt) and moving up to three stops (Or-opt), while the interleaving of the faces from
/// `counted_from` to `end` does not get worse. The other stops keep their positions.
void improve_route(const RouteProblem& problem, std::vector<std::size_t>& order, std::size_t counted_from,
                   std::size_t begin, std::size_t end);

/// Travel time of the stops in this order, seconds.
double route_time_s(const RouteProblem& problem, std::span<const std::size_t> order);

}  // namespace calib
