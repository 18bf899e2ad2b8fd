#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace calib {

/// How the directions of a fault count. kAny: it is in some mixture of them, and is to be seen. kEach: each
/// has a size of its own, and is to be told from the others.
enum class FaultDirections { kAny, kEach };

/// Something that touches are to show although other things are of unknown size.
struct DetectionQuestion {
  /// A matrix for each fault: a row per candidate, metres, and a column per direction in which the fault may
  /// be, each as large as it is to be seen.
  std::vector<Eigen::MatrixXd> faults;
  FaultDirections directions = FaultDirections::kEach;
  Eigen::MatrixXd free;  // a column for each quantity of unknown size
  /// Beside the faults the choice determines the free quantities, in each direction by at least this share of
  /// what an average choice of as many candidates does. A choice that leaves one of them almost open sees the
  /// faults better, but nobody knows then where the block is. One that does not leaves every fault open.
  /// Where it is over 0, the columns of `free` are orthonormal over all candidates.
  double free_share_min = 0.0;
};

struct DetectionProblem {
  Eigen::MatrixXd covariance;  // of the distances of all candidates when nothing is wrong, square metres
  std::vector<DetectionQuestion> questions;
  std::uint64_t seed = 1;  // of the starts; the same problem gives the same choice
};

/// How much of each fault these candidates leave open, summed: 1 / (1 + noncentrality) of the chi-square test
/// that sees it, that of kAny being summed over its directions; of kEach the trace of the posterior
/// covariance of their sizes for a prior of one each.
double doubt_left(const DetectionProblem& problem, const std::vector<std::size_t>& chosen);

/// The candidates, ascending, that leave the least doubt as far as exchanges find it: from several random
/// starts each chosen one is exchanged for a better one until none is. Throws std::logic_error when there are
/// fewer candidates than `count`.
std::vector<std::size_t> choose_for_detection(const DetectionProblem& problem, std::size_t count);

}  // namespace calib
