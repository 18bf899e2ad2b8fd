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

bool is_estimated(const LeastSquares& fit, int column) {
  return std::ranges::find(fit.arm_columns(), column) != fit.arm_columns().end();
}

/// The candidates, and what is beside rigid kinematics where it is estimated or has a standard deviation.
std::vector<int> all_known_columns(const IdentificationProblem& problem, const LeastSquares& fit) {
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  for (int i = kErrorParameterCount; i < kArmParameterCount; ++i) {
    if (is_estimated(fit, i) || problem.nongeometric_std[static_cast<std::size_t>(i - kErrorParameterCount)])
      columns.push_back(i);
  }
  return columns;
}

const char* source_name(NongeometricKind kind) {
  switch (kind) {
    case NongeometricKind::kCompliance:
      return "compliance";
    case NongeometricKind::kHarmonicCos:
    case NongeometricKind::kHarmonicSin:
      return "gear_harmonics";
    case NongeometricKind::kMass:
      return "masses";
  }
  throw std::logic_error("source_name: no such kind");
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

/// Of an estimated parameter of the arm that has a prior.
const char* source_name(int arm_column) {
  if (arm_column < kErrorParameterCount) return "makers_tolerances";
  return source_name(
      nongeometric_parameters()[static_cast<std::size_t>(arm_column - kErrorParameterCount)].kind);
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
  [[nodiscard]] const std::vector<UncertaintySource>& sources() const { return sources_; }
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
    sum.add_equation(artefact < 0 ? source_name(fit.arm_columns()[static_cast<std::size_t>(k)])
                                  : source_name(parameters[static_cast<std::size_t>(artefact)].kind),
                     Eigen::VectorXd::Unit(precision.size(), k), precision[k]);
  }
  for (const ArtefactEquation& equation : problem.artefact.equations) {
    Eigen::VectorXd direction = Eigen::VectorXd::Zero(precision.size());
    for (const auto& [index, weight] : equation.weights) direction[fit.arm_count() + index] = weight;
    sum.add_equation("block_size", direction, 1.0 / (equation.std_m * equation.std_m));
  }
}

/// An error that was not estimated: by how much one unit of it biases the estimated ones, with itself.
ArmVector bias_direction(const LeastSquares& fit, const FullLinearisation& whole, int column) {
  const Eigen::VectorXd moved =
      whole.estimated_covariance * whole.touch_information(whole.estimated, Eigen::all).col(column);
  ArmVector direction = ArmVector::Unit(column);
  for (std::size_t i = 0; i < fit.arm_columns().size(); ++i) {
    direction[fit.arm_columns()[i]] -= moved[static_cast<Eigen::Index>(i)];
  }
  return direction;
}

/// Adds what the arm does beside rigid kinematics and was not estimated: within the maker's figures it bends
/// the estimate and remains.
void add_nongeometric(const IdentificationProblem& problem, const LeastSquares& fit,
                      const FullLinearisation& whole, SourceSum& sum, UncertaintyBudget& result) {
  for (int column = kErrorParameterCount; column < kArmParameterCount; ++column) {
    const auto index = static_cast<std::size_t>(column - kErrorParameterCount);
    const auto& std = problem.nongeometric_std[index];
    if (!std || is_estimated(fit, column)) continue;
    const NongeometricKind kind = nongeometric_parameters()[index].kind;
    // A harmonic is a prior of what may be there: one that the touches show is estimated, what is left of the
    // others is in the noise that is measured.
    if (kind == NongeometricKind::kHarmonicCos || kind == NongeometricKind::kHarmonicSin) continue;
    const ArmVector direction = *std * bias_direction(fit, whole, column);
    const ArmMatrix covariance = direction * direction.transpose();
    result.held += covariance;
    sum.source(source_name(kind)).covariance += covariance;
  }
}

/// Adds what changes from posture to posture: it is in the noise of the touches, and at the tip once more.
void add_gears(const IdentificationProblem& problem, SourceSum& sum, UncertaintyBudget& result) {
  if (problem.gear_std_rad.isZero(0.0)) return;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int theta = *error_parameter_index("theta" + std::to_string(joint + 1));
    result.of_posture(theta, theta) = std::pow(problem.gear_std_rad[joint], 2);
  }
  sum.source("gears").covariance = result.of_posture;
}

/// Adds the errors that were not estimated: each is within its tolerance and biases the estimated ones.
void add_unseen(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                const LeastSquares& fit, const FullLinearisation& whole, SourceSum& sum,
                UncertaintyBudget& result) {
  std::vector<ArmVector> unknown;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    if (is_estimated(fit, column)) continue;
    const ArmVector direction = bias_direction(fit, whole, column);
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

FullLinearisation linearise_all_parameters(const IdentificationProblem& problem,
                                           const IdentificationOptions& options, LeastSquares& fit,
                                           const Estimate& estimate) {
  std::vector<int> columns = all_known_columns(problem, fit);
  LeastSquares everything(fit, options, columns);
  everything.linearise(estimate);
  FullLinearisation whole;
  const Eigen::Index count = kArmParameterCount + estimate.artefact.size();
  for (Eigen::Index k = 0; k < estimate.artefact.size(); ++k) {
    columns.push_back(kArmParameterCount + static_cast<int>(k));
  }
  whole.touch_information.setZero(count, count);
  whole.touch_gradient.setZero(count);
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto from = static_cast<Eigen::Index>(j);
    whole.touch_gradient[columns[j]] = everything.touch_gradient()[from];
    for (std::size_t i = 0; i < columns.size(); ++i)
      whole.touch_information(columns[i], columns[j]) =
          everything.touch_information()(static_cast<Eigen::Index>(i), from);
  }
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
                                        const FullLinearisation& whole, const TouchNoise& noise) {
  UncertaintyBudget result;
  result.noise_m = noise.std_m;
  result.degrees_of_freedom = std::max(1.0, noise.degrees_of_freedom);
  result.coverage_factor = student_two_sided_factor(kConfidence, result.degrees_of_freedom);

  const Eigen::MatrixXd& covariance = whole.estimated_covariance;
  const double ratio = result.noise_m / fit.noise_unit_m();
  const Eigen::MatrixXd of_noise = ratio * ratio * (covariance * fit.gradient_covariance() * covariance);
  SourceSum sum(fit, covariance);
  sum.add("touch_noise", of_noise);
  add_priors(problem, options, fit, sum);
  for (const UncertaintySource& source : sum.sources()) result.identified += source.covariance;
  add_unseen(problem, identifiable, fit, whole, sum, result);
  add_nongeometric(problem, fit, whole, sum, result);
  add_gears(problem, sum, result);
  result.sources = sum.take();
  result.artefact_std = (covariance.diagonal().tail(fit.unknown_count() - fit.arm_count())).cwiseSqrt();
  result.correlations = strongest(result.identified, fit.arm_columns());
  return result;
}

}  // namespace calib
