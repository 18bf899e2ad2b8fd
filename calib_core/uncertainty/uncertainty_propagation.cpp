#include "calib_core/uncertainty/uncertainty_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "calib_core/numerics/distributions.hpp"

namespace calib {
namespace {

constexpr double kConfidence = 0.95;
constexpr std::size_t kCorrelationsShown = 10;

std::vector<int> all_arm_columns() {
  std::vector<int> columns(kArmParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  return columns;
}

const char* source_name(ArtefactKind kind) {
  switch (kind) {
    case ArtefactKind::kFaceOffset:
      return "block_size";
    case ArtefactKind::kFaceTilt:
      return "squareness";
    case ArtefactKind::kStylusRadius:
      return "stylus_radius";
    case ArtefactKind::kPretravel:
      return "pretravel";
    case ArtefactKind::kTemperature:
      return "block_temperature";
  }
  throw std::logic_error("source_name: no such kind");
}

/// Sums covariances by the name of their source.
class SourceSum {
 public:
  explicit SourceSum(const LeastSquares& fit, const Eigen::MatrixXd& covariance)
      : columns_(fit.arm_columns()), covariance_(covariance) {}

  void add(const std::string& name, const Eigen::MatrixXd& of_unknowns) {
    ArmMatrix& covariance = source(name).covariance;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        covariance(columns_[i], columns_[j]) +=
            of_unknowns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  }
  /// Adds the contribution of a prior equation `direction . unknowns = value` of this precision.
  void add_equation(const std::string& name, const Eigen::VectorXd& direction, double precision) {
    const Eigen::VectorXd moved = covariance_ * direction * std::sqrt(precision);
    ArmVector arm = ArmVector::Zero();
    for (std::size_t i = 0; i < columns_.size(); ++i) arm[columns_[i]] = moved[static_cast<Eigen::Index>(i)];
    source(name).covariance.noalias() += arm * arm.transpose();
  }
  UncertaintySource& source(const std::string& name) {
    const auto found = std::ranges::find_if(sources_, [&](const auto& s) { return s.name == name; });
    if (found != sources_.end()) return *found;
    return sources_.emplace_back(UncertaintySource{name, ArmMatrix::Zero()});
  }
  std::vector<UncertaintySource> take() { return std::move(sources_); }

 private:
  const std::vector<int>& columns_;
  const Eigen::MatrixXd& covariance_;
  std::vector<UncertaintySource> sources_;
};

void add_priors(const IdentificationProblem& problem, const IdentificationOptions& options,
                const LeastSquares& fit, SourceSum& sum) {
  const Eigen::VectorXd precision = prior_precision(problem, fit.arm_columns(), options.prior);
  const auto& parameters = problem.artefact.parameters;
  for (Eigen::Index k = 0; k < precision.size(); ++k) {
    if (precision[k] == 0.0) continue;
    const Eigen::Index artefact = k - fit.arm_count();
    const char* name =
        artefact < 0 ? "makers_tolerances" : source_name(parameters[static_cast<std::size_t>(artefact)].kind);
    sum.add_equation(name, Eigen::VectorXd::Unit(precision.size(), k), precision[k]);
  }
  for (const ArtefactEquation& equation : problem.artefact.equations) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(precision.size());
    for (const auto& [index, weight] : equation.weights) direction[fit.arm_count() + index] = weight;
    sum.add_equation("block_size", direction, 1.0 / (equation.std_m * equation.std_m));
  }
}

/// Adds the errors that were not estimated: each is within its tolerance and biases the estimated ones.
void add_unseen(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                const LeastSquares& fit, const FullLinearisation& whole, SourceSum& sum,
                UncertaintyBudget& result) {
  std::vector<ArmVector> unknown;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    if (std::ranges::find(fit.arm_columns(), column) != fit.arm_columns().end()) continue;
    const Eigen::VectorXd moved =
        whole.estimated_covariance * whole.touch_information(whole.estimated, Eigen::all).col(column);
    ArmVector direction = ArmVector::Unit(column);
    for (std::size_t i = 0; i < fit.arm_columns().size(); ++i) {
      direction[fit.arm_columns()[i]] -= moved[static_cast<Eigen::Index>(i)];
    }
    const ParameterStatus status = identifiable.candidates[static_cast<std::size_t>(column)].status;
    const bool held = status == ParameterStatus::kWeak || status == ParameterStatus::kExcluded;
    if (const auto& tolerance = problem.tolerances[static_cast<std::size_t>(column)]) {
      (held ? result.held : result.unseen).noalias() +=
          *tolerance * *tolerance * direction * direction.transpose();
    } else {
      result.unseen_without_tolerance.push_back(column);
      unknown.push_back(direction);
    }
  }
  result.unknown_directions.resize(kArmParameterCount, static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    result.unknown_directions.col(static_cast<Eigen::Index>(i)) = unknown[i];
  }
  if (!result.held.isZero(0.0)) sum.source("held").covariance = result.held;
  sum.source("unseen").covariance = result.unseen;
}

std::vector<Correlation> strongest(const ArmMatrix& covariance, const std::vector<int>& columns) {
  std::vector<Correlation> all;
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      const int a = columns[i], b = columns[j];
      all.push_back({a, b, covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b))});
    }
  }
  const std::size_t shown = std::min(kCorrelationsShown, all.size());
  std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(shown), std::ranges::greater{},
                            [](const Correlation& c) { return std::abs(c.coefficient); });
  all.resize(shown);
  return all;
}

}  // namespace

FullLinearisation linearise_all_parameters(const IdentificationOptions& options, LeastSquares& fit,
                                           const Estimate& estimate) {
  LeastSquares everything(fit, options, all_arm_columns());
  everything.linearise(estimate);
  FullLinearisation whole{everything.touch_information(), everything.touch_gradient(), {}, {}};
  for (const int column : fit.arm_columns()) whole.estimated.push_back(column);
  for (Eigen::Index k = 0; k < estimate.artefact.size(); ++k) {
    whole.estimated.push_back(kArmParameterCount + k);
  }
  whole.estimated_covariance = inverse_information(fit.information());
  return whole;
}

UncertaintyBudget propagate_uncertainty(const IdentificationProblem& problem,
                                        const IdentificationOptions& options,
                                        const IdentifiableSet& identifiable, const LeastSquares& fit,
                                        const FullLinearisation& whole, const Estimate& estimate,
                                        const std::optional<LackOfFit>& misfit) {
  UncertaintyBudget result;
  const auto estimated = estimated_noise_m(fit, estimate);
  const bool is_rejected = misfit && misfit->p < kLackOfFitWidens && estimated > problem.touch_noise_m;
  const bool use_declared = problem.touch_noise_m > 0.0 && !is_rejected;
  result.noise_m = use_declared ? problem.touch_noise_m : estimated.value_or(0.0);
  result.degrees_of_freedom =
      use_declared ? std::numeric_limits<double>::infinity() : std::max(1, fit.degrees_of_freedom());
  result.coverage_factor = student_two_sided_factor(kConfidence, result.degrees_of_freedom);

  const Eigen::MatrixXd& covariance = whole.estimated_covariance;
  const double ratio = result.noise_m / fit.noise_unit_m();
  const Eigen::MatrixXd of_noise = ratio * ratio * (covariance * fit.gradient_covariance() * covariance);
  SourceSum sum(fit, covariance);
  sum.add("touch_noise", of_noise);
  add_priors(problem, options, fit, sum);
  add_unseen(problem, identifiable, fit, whole, sum, result);
  result.sources = sum.take();
  for (const UncertaintySource& source : result.sources) {
    const bool of_fit = source.name != "unseen" && source.name != "held";
    if (of_fit) result.identified += source.covariance;
  }
  result.artefact_std = (covariance.diagonal().tail(estimate.artefact.size())).cwiseSqrt();
  result.correlations = strongest(result.identified, fit.arm_columns());
  return result;
}

}  // namespace calib
