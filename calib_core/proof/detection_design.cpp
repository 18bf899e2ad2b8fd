#include "calib_core/proof/detection_design.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "calib_core/numerics/scaled_cholesky.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/proof/internal/whitened_rows.hpp"

namespace calib {
namespace {

constexpr int kDetectionStarts = 3;
constexpr int kDetectionRoundsMax = 10;
/// A smaller improvement of the doubt, as a share of it, is none.
constexpr double kDoubtImprovementMin = 1e-4;

/// Of what an average choice says of the free quantities, the share in the direction that it says least of.
/// Of orthonormal columns the Gram matrix of an average choice is the identity times its share of the rows.
double least_free_share(const Eigen::MatrixXd& free, const std::vector<std::size_t>& chosen) {
  const Eigen::MatrixXd rows = free(chosen, Eigen::all);
  const Eigen::MatrixXd gram = rows.transpose() * rows;
  const double average = static_cast<double>(rows.rows()) / static_cast<double>(free.rows());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly).eigenvalues()[0] /
         average;
}

double open_share(const Eigen::MatrixXd& rest, FaultDirections directions) {
  if (directions == FaultDirections::kAny || rest.cols() == 1) return 1.0 / (1.0 + rest.squaredNorm());
  Eigen::MatrixXd information = rest.transpose() * rest;
  information.diagonal().array() += 1.0;
  return ScaledCholesky(information).inverse().trace();
}

/// Exchanges each chosen candidate once for the best other one; returns the doubt that is left.
double exchange_round(const DetectionProblem& problem, std::vector<std::size_t>& chosen, double doubt) {
  const auto candidates = static_cast<std::size_t>(problem.covariance.rows());
  for (std::size_t& place : chosen) {
    std::size_t best = place;
    for (std::size_t other = 0; other < candidates; ++other) {
      if (std::ranges::find(chosen, other) != chosen.end()) continue;
      const std::size_t before = place;
      place = other;
      const double tried = doubt_left(problem, chosen);
      place = before;
      if (tried >= doubt) continue;
      doubt = tried;
      best = other;
    }
    place = best;
  }
  return doubt;
}

std::vector<std::size_t> random_start(std::size_t candidates, std::size_t count, UniformChance& chance) {
  std::vector<std::size_t> all(candidates);
  std::iota(all.begin(), all.end(), std::size_t{0});
  for (std::size_t i = 0; i < count; ++i) {
    const auto pick = static_cast<std::size_t>(chance() * static_cast<double>(candidates - i));
    std::swap(all[i], all[i + pick]);
  }
  all.resize(count);
  return all;
}

}  // namespace

double doubt_left(const DetectionProblem& problem, const std::vector<std::size_t>& chosen) {
  const Eigen::MatrixXd covariance = problem.covariance(chosen, chosen);
  double doubt = 0.0;
  for (const DetectionQuestion& question : problem.questions) {
    const double share = question.free_share_min > 0.0 ? least_free_share(question.free, chosen) : 0.0;
    if (share < question.free_share_min) {
      // All are open, and more so the farther the choice is from one that counts: exchanges lead there.
      for (const Eigen::MatrixXd& fault : question.faults) doubt += static_cast<double>(fault.cols());
      doubt += 1.0 - share / question.free_share_min;
      continue;
    }
    const WhitenedRows white(covariance, question.free(chosen, Eigen::all));
    for (const Eigen::MatrixXd& fault : question.faults)
      doubt += open_share(white.rest(fault(chosen, Eigen::all)), question.directions);
  }
  return doubt;
}

std::vector<std::size_t> choose_for_detection(const DetectionProblem& problem, std::size_t count) {
  const auto candidates = static_cast<std::size_t>(problem.covariance.rows());
  if (candidates < count) throw std::logic_error("fewer candidates than touches are to be chosen");
  UniformChance chance(problem.seed);
  std::vector<std::size_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < kDetectionStarts; ++start) {
    std::vector<std::size_t> chosen = random_start(candidates, count, chance);
    double doubt = doubt_left(problem, chosen);
    for (int round = 0; round < kDetectionRoundsMax; ++round) {
      const double before = doubt;
      doubt = exchange_round(problem, chosen, doubt);
      if (doubt > (1.0 - kDoubtImprovementMin) * before) break;
    }
    if (doubt >= least) continue;
    least = doubt;
    best = std::move(chosen);
  }
  std::ranges::sort(best);
  return best;
}

}  // namespace calib
