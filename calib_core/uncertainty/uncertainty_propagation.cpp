#include "calib_core/uncertainty/uncertainty_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "calib_core/uncertainty/internal/source_sum.hpp"

namespace calib {
namespace {

/// The candidates, and what is beside rigid kinematics where it is estimated or has a standard deviation.
std::vector<int> all_known_columns(const IdentificationProblem& problem, const LeastSquares& fit) {
  std::vector<int> columns(kErrorParameterCount);
  std::iota(columns.begin(), columns.end(), 0);
  for (int i = kErrorParameterCount; i < kArmParameterCount; ++i) {
    if (is_estimated(fit, i) || std_unless_estimated(problem, i, {1.0, 1.0})) columns.push_back(i);
  }
  return columns;
}

const char* source_name(ArtefactKind kind) {
  switch (kind) {
    case ArtefactKind::kFaceOffset:
    case ArtefactKind::kSphereCenter:
    case ArtefactKind::kSphereRadius:
    case ArtefactKind::kBoreAxis:
    case ArtefactKind::kBoreRadius:
      return "block_size";
    case ArtefactKind::kFaceTilt:
    case ArtefactKind::kBoreTilt:
      return "squareness";
    case ArtefactKind::kStylusRadius:
      return "stylus_radius";
    case ArtefactKind::kPretravel:
      return "pretravel";
    case ArtefactKind::kTemperature:
      return "block_temperature";
    case ArtefactKind::kPlaceShift:
    case ArtefactKind::kPlaceTurn:
      return "block_places";
    case ArtefactKind::kTipCenter:
      return "stylus_tips";
  }
  throw std::logic_error("source_name: no such kind");
}

/// Of an estimated parameter of the arm that has a prior.
const char* source_name(int arm_column) {
  if (arm_column < kErrorParameterCount) return "makers_tolerances";
  return source_name(
      nongeometric_parameters()[static_cast<std::size_t>(arm_column - kErrorParameterCount)].kind);
}

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

}  // namespace

JointVector gear_std_beside(const IdentificationProblem& problem, const std::vector<int>& arm_columns) {
  JointVector variances = problem.gear_std_rad.cwiseAbs2();
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int position = ripple_position(joint);
    const auto& std = problem.nongeometric_std[static_cast<std::size_t>(position)];
    if (std && std::ranges::find(arm_columns, nongeometric_index(position)) != arm_columns.end())
      variances[joint] = std::max(0.0, variances[joint] - *std * *std);
  }
  return variances.cwiseSqrt();
}

std::optional<double> std_unless_estimated(const IdentificationProblem& problem, int column,
                                           const HarmonicShares& shares) {
  if (column < kErrorParameterCount) return problem.tolerances[static_cast<std::size_t>(column)];
  const int position = column - kErrorParameterCount;
  if (is_ripple(position)) return std::nullopt;
  const auto& std = problem.nongeometric_std[static_cast<std::size_t>(position)];
  if (!std) return std;
  if (is_harmonic(position)) return std::sqrt(shares.first) * *std;
  if (is_second_harmonic(position)) return std::sqrt(shares.second) * *std;
  return std;
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
  whole.patterns = touch_patterns(problem);
  if (!whole.patterns.empty()) {
    const Eigen::MatrixXd displaced = pattern_displacements(problem, everything, estimate);
    const Eigen::MatrixXd of_columns = everything.rows().transpose() * displaced;
    whole.pattern_columns.setZero(count, displaced.cols());
    for (Eigen::Index j = 0; j < of_columns.rows(); ++j)
      whole.pattern_columns.row(whole.position_of(j)) = of_columns.row(j);
    whole.pattern_information = displaced.transpose() * displaced;
    whole.pattern_gradient = displaced.transpose() * everything.weighted_targets();
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
  sum.add_first_to(result.of_noise, 1);
  sum.add_first_to(result.identified, sum.sources().size());
  result.artefact_std = sum.artefact_variance().cwiseSqrt();
  result.sources = sum.take();
  return result;
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
