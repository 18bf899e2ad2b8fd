#include "calib_core/planning/internal/condition_number_exchange.hpp"

#include <cmath>

#include "calib_core/numerics/condition_number.hpp"

namespace calib {
namespace {

/// The substitute criterion is trace(C^kPower).
constexpr int kPower = 4;
constexpr int kRoundsMax = 12;
constexpr double kWorthIt = 1e-3;
constexpr std::size_t kShortList = 24;

/// The derivative of trace(C^kPower), normalised: the weight of the linearised criterion.
Eigen::MatrixXd power_weight(const Eigen::MatrixXd& information) {
  SymmetricEigen eigen;
  eigen.compute(information);
  const Eigen::VectorXd variances = eigen.values().cwiseInverse();
  const Eigen::VectorXd weights = (variances / variances.maxCoeff()).array().pow(kPower - 1);
  return eigen.vectors() * weights.asDiagonal() * eigen.vectors().transpose();
}

/// One exchange by the condition number itself of the candidate that was chosen first.
bool exchange_exactly(FedorovExchange& exchange, double& condition_number) {
  const std::size_t old = exchange.chosen().front();
  const auto count = static_cast<int>(exchange.chosen().size());
  exchange.remove(0);
  std::size_t best = old;
  double least = condition_number * (1.0 - kWorthIt);
  for (const std::size_t candidate : exchange.best_candidates(kShortList, count)) {
    const double reached = condition_number_of_information(
        exchange.information() + exchange.row(candidate) * exchange.row(candidate).transpose());
    if (reached >= least) continue;
    least = reached;
    best = candidate;
  }
  exchange.add(best);
  if (best == old) return false;
  condition_number = least;
  return true;
}

}  // namespace

void reduce_condition_number(FedorovExchange& exchange) {
  std::vector<std::size_t> best = exchange.chosen();
  double least = condition_number_of_information(exchange.information());
  for (int round = 0; round < kRoundsMax; ++round) {
    exchange.set_weight(power_weight(exchange.information()));
    if (!exchange.improve(kWorthIt)) break;
    const double reached = condition_number_of_information(exchange.information());
    if (reached >= least) continue;
    least = reached;
    best = exchange.chosen();
  }
  exchange.restart(best);
  for (int round = 0; round < kRoundsMax; ++round) {
    exchange.set_weight(power_weight(exchange.information()));
    bool changed = false;
    for (std::size_t turn = 0; turn < best.size(); ++turn) {
      if (exchange_exactly(exchange, least)) changed = true;
    }
    if (!changed) break;
  }
  exchange.restart(exchange.chosen());
}

}  // namespace calib
