#include "calib_core/uncertainty/uncertainty_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "calib_core/uncertainty/left_out_effects.hpp"

namespace calib {
namespace {

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
    case ArtefactKind::kSphereCenter:
    case ArtefactKind::kSphereRadius:
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
  SourceSum(const std::vector<int>& columns, std::vector<UncertaintySource> sources)
      : columns_(columns), sources_(std::move(sources)) {}

  void add(const std::string& name, const Eigen::MatrixXd& of_unknowns) {
    ArmCovariance& covariance = source(name).covariance;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      for (std::size_t i = 0; i < columns_.size(); ++i) {
        covariance(columns_[i], columns_[j]) +=
            of_unknowns(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  }
  UncertaintySource& source(const std::string& name) {
    const auto found = std::ranges::find_if(sources_, [&](const auto& s) { return s.name == name; });
    if (found != sources_.end()) return *found;
    return sources_.emplace_back(UncertaintySource{name, no_covariance()});
  }
  [[nodiscard]] const std::vector<UncertaintySource>& sources() const { return sources_; }
  std::vector<UncertaintySource> take() { return std::move(sources_); }

 private:
  const std::vector<int>& columns_;
  std::vector<UncertaintySource> sources_;
};

/// The contributions of prior equations `direction . unknowns = value` to the covariance of the unknowns, by
/// source.
class PriorSum {
 public:
  explicit PriorSum(const Eigen::MatrixXd& covariance) : covariance_(covariance) {}

  void add(const char* name, const Eigen::VectorXd& moved_by_one, double precision) {
    auto found = std::ranges::find(parts_, std::string_view(name), &Part::first);
    if (found == parts_.end())
      found =
          parts_.emplace(parts_.end(), name, Eigen::MatrixXd::Zero(covariance_.rows(), covariance_.cols()));
    found->second.selfadjointView<Eigen::Lower>().rankUpdate(moved_by_one, precision);
  }
  void add_to(SourceSum& sum) const {
    for (const auto& [name, lower] : parts_)
      sum.add(std::string(name), lower.selfadjointView<Eigen::Lower>());
  }

 private:
  using Part = std::pair<std::string_view, Eigen::MatrixXd>;
  const Eigen::MatrixXd& covariance_;
  std::vector<Part> parts_;
};

void add_priors(const IdentificationProblem& problem, const IdentificationOptions& options,
                const LeastSquares& fit, const Eigen::MatrixXd& covariance, SourceSum& sum) {
  const Eigen::VectorXd precision = prior_precision(problem, fit.arm_columns(), options.prior);
  const auto& parameters = problem.artefact.parameters;
  PriorSum priors(covariance);
  for (Eigen::Index k = 0; k < precision.size(); ++k) {
    if (precision[k] == 0.0) continue;
    const Eigen::Index artefact = k - fit.arm_count();
    priors.add(artefact < 0 ? source_name(fit.arm_columns()[static_cast<std::size_t>(k)])
                            : source_name(parameters[static_cast<std::size_t>(artefact)].kind),
               covariance.col(k), precision[k]);
  }
  for (const ArtefactEquation& equation : problem.artefact.equations) {
    Eigen::VectorXd moved = Eigen::VectorXd::Zero(precision.size());
    for (const auto& [index, weight] : equation.weights)
      moved += weight * covariance.col(fit.arm_count() + index);
    priors.add(source_name(ArtefactKind::kFaceOffset), moved, 1.0 / (equation.std_m * equation.std_m));
  }
  priors.add_to(sum);
}

/// True minus estimated errors of arm and artefact when the touches are displaced by something that was not
/// estimated: `gradient` is the sum of their rows times their displacements.
Eigen::VectorXd bias(const FullLinearisation& whole, const Eigen::Ref<const Eigen::VectorXd>& gradient) {
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(whole.touch_information.rows());
  direction(whole.estimated) = -whole.estimated_covariance * gradient(whole.estimated);
  return direction;
}

/// An error that was not estimated: by how much one unit of it biases the estimated ones, with itself.
Eigen::VectorXd bias_direction(const FullLinearisation& whole, int column) {
  Eigen::VectorXd direction = bias(whole, whole.touch_information.col(column));
  direction[column] += 1.0;
  return direction;
}

/// The harmonics that have a standard deviation, as columns.
std::vector<Eigen::Index> known_harmonics(const IdentificationProblem& problem) {
  std::vector<Eigen::Index> columns;
  for (int position = harmonic_position(0); is_harmonic(position); ++position) {
    if (problem.nongeometric_std[static_cast<std::size_t>(position)])
      columns.push_back(nongeometric_index(position));
  }
  return columns;
}

/// The variance that harmonics which were left out may still have, as a share of the maker's: what the
/// residuals leave of it.
double harmonic_share(const IdentificationProblem& problem, const LeastSquares& fit,
                      const FullLinearisation& whole, double noise_variance) {
  const std::vector<Eigen::Index> columns = known_harmonics(problem);
  if (columns.empty() || is_estimated(fit, static_cast<int>(columns.front()))) return 0.0;
  Eigen::VectorXd std(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std[static_cast<Eigen::Index>(i)] =
        *problem.nongeometric_std[static_cast<std::size_t>(columns[i] - kErrorParameterCount)];
  }
  const Eigen::MatrixXd shared = whole.touch_information(whole.estimated, columns) * std.asDiagonal();
  Eigen::MatrixXd information =
      std.asDiagonal() * whole.touch_information(columns, columns) * std.asDiagonal();
  information.noalias() -= shared.transpose() * whole.estimated_covariance * shared;
  return mean_variance_share(information, std.cwiseProduct(whole.touch_gradient(columns)), noise_variance);
}

/// Adds what was not estimated: `displacement` is that by one standard deviation.
void add_left_out(const Eigen::VectorXd& displacement, ArmCovariance& covariance, UncertaintyBudget& result) {
  const ArmVector of_arm = displacement.head<kArmParameterCount>();
  covariance.noalias() += of_arm * of_arm.transpose();
  result.left_out.conservativeResize(displacement.size(), result.left_out.cols() + 1);
  result.left_out.rightCols<1>() = displacement;
}

void add_held(const std::string& name, const Eigen::VectorXd& displacement, SourceSum& sum,
              UncertaintyBudget& result) {
  const ArmVector of_arm = displacement.head<kArmParameterCount>();
  sum.source(name).covariance.noalias() += of_arm * of_arm.transpose();
  add_left_out(displacement, result.held, result);
}

/// Adds what the arm does beside rigid kinematics and was not estimated: within the maker's figures it bends
/// the estimate and remains.
void add_nongeometric(const IdentificationProblem& problem, const LeastSquares& fit,
                      const FullLinearisation& whole, double noise_variance, SourceSum& sum,
                      UncertaintyBudget& result) {
  result.harmonic_share = harmonic_share(problem, fit, whole, noise_variance);
  for (int column = kErrorParameterCount; column < kArmParameterCount; ++column) {
    const auto index = static_cast<std::size_t>(column - kErrorParameterCount);
    const auto std = std_unless_estimated(problem, column, result.harmonic_share);
    if (!std || is_estimated(fit, column)) continue;
    add_held(source_name(nongeometric_parameters()[index].kind), *std * bias_direction(whole, column), sum,
             result);
  }
}

/// Adds the lag of the joints: every touch ends a search, so that it displaces them by a pattern.
void add_lag(const IdentificationProblem& problem, const FullLinearisation& whole, SourceSum& sum,
             UncertaintyBudget& result) {
  result.lagged.resize(whole.touch_information.rows(), whole.lag_gradient.cols());
  for (Eigen::Index joint = 0; joint < whole.lag_gradient.cols(); ++joint) {
    // The recorded joints are ahead of the true ones: the model sees the touches displaced, not the arm.
    result.lagged.col(joint) = -problem.gear_lag_std_rad[joint] * bias(whole, whole.lag_gradient.col(joint));
    const ArmVector of_arm = result.lagged.col(joint).head<kArmParameterCount>();
    const ArmCovariance covariance = of_arm * of_arm.transpose();
    sum.source("backlash").covariance += covariance;
    result.held += covariance;
  }
}

/// Adds what changes from posture to posture: it is in the noise of the touches, and at the tip once more.
void add_gears(const IdentificationProblem& problem, SourceSum& sum, UncertaintyBudget& result) {
  if (problem.gear_std_rad.isZero(0.0)) return;
  for (int joint = 0; joint < kJointCount; ++joint) {
    result.of_posture(theta_index(joint), theta_index(joint)) =
        result.gear_share * std::pow(problem.gear_std_rad[joint], 2);
  }
  sum.source("gears").covariance = result.of_posture;
}

/// Adds the drift, as a displacement along the lengths before joint 1: they are at right angles where axis 1
/// stands on the block's base. No touch says in which direction, so that it is the same in each.
void add_drift(const IdentificationProblem& problem, SourceSum& sum, UncertaintyBudget& result) {
  if (problem.drift_m == 0.0) return;
  ArmCovariance& covariance = sum.source("drift").covariance;
  for (const char* name : {"r0", "d1", "r1"}) {
    const int length = *error_parameter_index(name);
    covariance(length, length) = std::pow(problem.drift_m / 2.0, 2);
  }
  result.of_posture += covariance;
}

/// Adds the errors that were not estimated: each is within its tolerance and biases the estimated ones.
void add_unseen(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                const LeastSquares& fit, const FullLinearisation& whole, SourceSum& sum,
                UncertaintyBudget& result) {
  std::vector<Eigen::VectorXd> unknown;
  ArmCovariance held = no_covariance();
  for (int column = 0; column < kErrorParameterCount; ++column) {
    if (is_estimated(fit, column)) continue;
    const Eigen::VectorXd direction = bias_direction(whole, column);
    const ParameterStatus status = identifiable.candidates[static_cast<std::size_t>(column)].status;
    const bool is_held = status == ParameterStatus::kWeak || status == ParameterStatus::kExcluded;
    if (const auto tolerance = std_unless_estimated(problem, column, result.harmonic_share)) {
      add_left_out(*tolerance * direction, is_held ? held : result.unseen, result);
    } else {
      result.unseen_without_tolerance.push_back(column);
      unknown.push_back(direction);
    }
  }
  result.unknown_directions.resize(kArmParameterCount, static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    result.unknown_directions.col(static_cast<Eigen::Index>(i)) = unknown[i].head<kArmParameterCount>();
  }
  if (!held.isZero(0.0)) sum.source("held").covariance = held;
  result.held += held;
  sum.source("unseen").covariance = result.unseen;
}

std::vector<Correlation> strongest(const ArmCovariance& covariance, const std::vector<int>& columns) {
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

Eigen::MatrixXd lag_displacements(const IdentificationProblem& problem, const LeastSquares& fit,
                                  const Estimate& estimate) {
  const KinematicModel arm = apply(problem.nominal, estimate.arm);
  const PreparedModel prepared = prepare(arm);
  Eigen::MatrixXd displaced = Eigen::MatrixXd::Zero(fit.rows().rows(), kJointCount);
  for (std::size_t i = 0; i < fit.touches().size(); ++i) {
    if (!fit.kept()[i]) continue;
    const Touch& touch = problem.touches[fit.touches()[i]];
    const ContactSurface& surface = problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)];
    const Chain chain = forward_chain(prepared, touch.joints);
    const JointVector directions = search_directions(arm, chain, normal_at(surface, chain.tip_in_block_m()));
    const auto row = static_cast<Eigen::Index>(i);
    for (int joint = 0; joint < kJointCount; ++joint)
      displaced(row, joint) = directions[joint] * fit.rows()(row, theta_index(joint));
  }
  return displaced;
}

std::optional<double> std_unless_estimated(const IdentificationProblem& problem, int column,
                                           double harmonic_share) {
  if (column < kErrorParameterCount) return problem.tolerances[static_cast<std::size_t>(column)];
  const int position = column - kErrorParameterCount;
  const auto& std = problem.nongeometric_std[static_cast<std::size_t>(position)];
  if (!std || !is_harmonic(position)) return std;
  return std::sqrt(harmonic_share) * *std;
}

FullLinearisation linearise_all_parameters(const IdentificationProblem& problem,
                                           const IdentificationOptions& options, LeastSquares& fit,
                                           const Estimate& estimate,
                                           std::optional<Eigen::MatrixXd> covariance) {
  FullLinearisation whole;
  whole.columns = all_known_columns(problem, fit);
  LeastSquares everything(fit, options, whole.columns);
  everything.linearise(estimate);
  const Eigen::Index count = kArmParameterCount + estimate.artefact.size();
  whole.touch_information.setZero(count, count);
  whole.touch_gradient.setZero(count);
  for (Eigen::Index j = 0; j < everything.unknown_count(); ++j) {
    whole.touch_gradient[whole.position_of(j)] = everything.touch_gradient()[j];
    for (Eigen::Index i = 0; i < everything.unknown_count(); ++i)
      whole.touch_information(whole.position_of(i), whole.position_of(j)) =
          everything.touch_information()(i, j);
  }
  if (!problem.gear_lag_std_rad.isZero(0.0)) {
    const Eigen::MatrixXd of_columns =
        everything.rows().transpose() * lag_displacements(problem, everything, estimate);
    whole.lag_gradient.setZero(count, kJointCount);
    for (Eigen::Index j = 0; j < of_columns.rows(); ++j)
      whole.lag_gradient.row(whole.position_of(j)) = of_columns.row(j);
  }
  for (const int column : fit.arm_columns()) whole.estimated.push_back(column);
  for (Eigen::Index k = 0; k < estimate.artefact.size(); ++k) {
    whole.estimated.push_back(kArmParameterCount + k);
  }
  whole.estimated_covariance = covariance ? std::move(*covariance) : inverse_information(fit.information());
  return whole;
}

UncertaintyBudget fitted_uncertainty(const IdentificationProblem& problem,
                                     const IdentificationOptions& options, const LeastSquares& fit,
                                     const Eigen::MatrixXd& covariance, const TouchNoise& noise) {
  UncertaintyBudget result;
  result.noise_m = noise.std_m;
  result.degrees_of_freedom = std::max(1.0, noise.degrees_of_freedom);
  const double ratio = result.noise_m / fit.noise_unit_m();
  SourceSum sum(fit.arm_columns(), {});
  sum.add("touch_noise", ratio * ratio * (covariance * fit.gradient_covariance() * covariance));
  add_priors(problem, options, fit, covariance, sum);
  result.of_noise = sum.sources().front().covariance;
  for (const UncertaintySource& source : sum.sources()) result.identified += source.covariance;
  result.sources = sum.take();
  result.artefact_std = (covariance.diagonal().tail(fit.unknown_count() - fit.arm_count())).cwiseSqrt();
  return result;
}

void add_unfitted(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                  const LeastSquares& fit, const FullLinearisation& whole, UncertaintyBudget& fitted) {
  SourceSum sum(fit.arm_columns(), std::move(fitted.sources));
  const double ratio = fitted.noise_m / fit.noise_unit_m();
  fitted.left_out.resize(whole.touch_information.rows(), 0);
  add_unseen(problem, identifiable, fit, whole, sum, fitted);
  add_nongeometric(problem, fit, whole, ratio * ratio, sum, fitted);
  add_lag(problem, whole, sum, fitted);
  add_gears(problem, sum, fitted);
  add_drift(problem, sum, fitted);
  fitted.sources = sum.take();
  fitted.correlations = strongest(fitted.identified, fit.arm_columns());
}

UncertaintyBudget propagate_uncertainty(const IdentificationProblem& problem,
                                        const IdentificationOptions& options,
                                        const IdentifiableSet& identifiable, const LeastSquares& fit,
                                        const FullLinearisation& whole, const TouchNoise& noise) {
  UncertaintyBudget result = fitted_uncertainty(problem, options, fit, whole.estimated_covariance, noise);
  add_unfitted(problem, identifiable, fit, whole, result);
  return result;
}

}  // namespace calib
