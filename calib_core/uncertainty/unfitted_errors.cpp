// The second half of uncertainty_propagation: what was not fitted.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "calib_core/numerics/decompositions.hpp"
#include "calib_core/numerics/halton.hpp"
#include "calib_core/uncertainty/internal/source_sum.hpp"
#include "calib_core/uncertainty/left_out_effects.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

constexpr std::size_t kCorrelationsShown = 10;

/// Of the maker's variance of the first harmonics, what is expected before any touch: of these, and of the
/// second ones. A gear is eccentric before it is oval.
constexpr double kFirstHarmonicShare = 1.0 / 6.0, kSecondHarmonicShare = 1.0 / 12.0;

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

/// The same of an error of unknown size that the touches do not tell from others, to say whether it moves the
/// tip at all. It was found on the nominal arm, where the tip's derivatives are taken, and there the others
/// absorb it without a rest: linearised at the estimate it would leave one, however small, of unknown size.
Eigen::VectorXd unseen_direction(const IdentificationProblem& problem, const CandidateStatus& candidate,
                                 const LeastSquares& fit, const FullLinearisation& whole, int column) {
  const bool is_grouped =
      candidate.status == ParameterStatus::kGrouped || candidate.status == ParameterStatus::kNoEffect;
  if (!is_grouped || problem.columns) return bias_direction(whole, column);  // nothing was found of this one
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(whole.touch_information.rows());
  direction[column] = 1.0;
  for (const auto& [other, factor] : candidate.grouped_with) {
    direction[other] -= factor;
    if (!is_estimated(fit, other)) direction += factor * bias_direction(whole, other);  // held since
  }
  const std::vector<int> leading = parameters_without_prior(problem.artefact);
  for (const auto& [index, factor] : candidate.grouped_with_leading)
    direction[kArmParameterCount + leading[static_cast<std::size_t>(index)]] -= factor;
  return direction;
}

/// The harmonics of one kind that have a standard deviation, as columns.
std::vector<Eigen::Index> known_harmonics(const IdentificationProblem& problem, bool (*is_one)(int)) {
  std::vector<Eigen::Index> columns;
  for (int position = 0; position < kNongeometricCount; ++position) {
    if (is_one(position) && problem.nongeometric_std[static_cast<std::size_t>(position)])
      columns.push_back(nongeometric_index(position));
  }
  return columns;
}

/// The variance that harmonics of one kind which were left out may still have, as a share of the maker's:
/// what the residuals leave of it; all of it beside others that the touches asked for.
double harmonic_share(const IdentificationProblem& problem, const LeastSquares& fit,
                      const FullLinearisation& whole, bool (*is_one)(int),
                      const std::optional<NoiseEvidence>& noise, double expected_share) {
  std::vector<Eigen::Index> columns = known_harmonics(problem, is_one);
  const auto estimated = std::erase_if(
      columns, [&](Eigen::Index column) { return is_estimated(fit, static_cast<int>(column)); });
  if (columns.empty()) return 0.0;
  if (estimated > 0) return 1.0;
  if (!noise) return expected_share;
  Eigen::VectorXd std(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    std[static_cast<Eigen::Index>(i)] =
        *problem.nongeometric_std[static_cast<std::size_t>(columns[i] - kErrorParameterCount)];
  }
  return mean_variance_share(
      evidence_of_group(whole.touch_information(columns, columns),
                        whole.touch_information(whole.estimated, columns), whole.touch_gradient(columns), std,
                        whole.estimated_covariance),
      *noise, expected_share);
}

/// First harmonics have been tried, so that what is left of them passes for noise; second ones have not.
HarmonicShares harmonic_shares(const IdentificationProblem& problem, const LeastSquares& fit,
                               const FullLinearisation& whole) {
  std::optional<NoiseEvidence> with_first;
  if (whole.noise) with_first = {.otherwise = whole.noise->otherwise};
  return {harmonic_share(problem, fit, whole, is_harmonic, with_first, kFirstHarmonicShare),
          harmonic_share(problem, fit, whole, is_second_harmonic, whole.noise, kSecondHarmonicShare)};
}

/// Most arms have little beside the candidates, and the rest of a displacement is 0 then.
void add_square(const Eigen::VectorXd& displacement, ArmCovariance& covariance) {
  Eigen::Index end = kArmParameterCount;
  while (end > 0 && displacement[end - 1] == 0.0) --end;
  const auto of_arm = displacement.head(end);
  covariance.topLeftCorner(end, end).noalias() += of_arm * of_arm.transpose();
}

/// Adds what was not estimated: `displacement` is that by one standard deviation.
void add_left_out(const Eigen::VectorXd& displacement, UncertaintyBudget& result) {
  result.left_out.conservativeResize(displacement.size(), result.left_out.cols() + 1);
  result.left_out.rightCols<1>() = displacement;
}

void add_held(const std::string& name, const Eigen::VectorXd& displacement, SourceSum& sum,
              UncertaintyBudget& result) {
  add_square(displacement, sum.source(name).covariance);
  add_square(displacement, result.held);
  add_left_out(displacement, result);
}

/// Adds what the arm does beside rigid kinematics and was not estimated: within the maker's figures it bends
/// the estimate and remains.
void add_nongeometric(const IdentificationProblem& problem, const LeastSquares& fit,
                      const FullLinearisation& whole, SourceSum& sum, UncertaintyBudget& result) {
  result.harmonic_shares = harmonic_shares(problem, fit, whole);
  for (int column = kErrorParameterCount; column < kArmParameterCount; ++column) {
    const auto index = static_cast<std::size_t>(column - kErrorParameterCount);
    const auto std = std_unless_estimated(problem, column, result.harmonic_shares);
    if (!std || is_estimated(fit, column)) continue;
    add_held(source_name(nongeometric_parameters()[index].kind), *std * bias_direction(whole, column), sum,
             result);
  }
}

/// Adds what displaces all touches by a pattern: the lag of the joints at the end of a search, the pre-travel
/// of a push from the side.
void add_patterns(const FullLinearisation& whole, SourceSum& sum, UncertaintyBudget& result) {
  const auto count = std::ssize(whole.patterns);
  result.patterned.resize(whole.touch_information.rows(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const TouchPattern& pattern = whole.patterns[static_cast<std::size_t>(k)];
    result.patterned.col(k) = pattern.std * bias(whole, whole.pattern_columns.col(k));
    add_square(result.patterned.col(k), sum.source(pattern.source).covariance);
    add_square(result.patterned.col(k), result.held);
  }
}

/// Adds what changes from posture to posture: it is in the noise of the touches, and at the tip once more.
void add_gears(const IdentificationProblem& problem, const LeastSquares& fit, SourceSum& sum,
               UncertaintyBudget& result) {
  if (problem.gear_std_rad.isZero(0.0)) return;
  const JointVector std_rad = gear_std_beside(problem, fit.arm_columns());
  for (int joint = 0; joint < kJointCount; ++joint) {
    result.of_posture(theta_index(joint), theta_index(joint)) =
        result.gear_share * std::pow(std_rad[joint], 2);
  }
  sum.source("gears").covariance += result.of_posture;  // beside the ripples that were estimated
}

/// The changes of the block's place (three columns, rows: ArmVector) that displace the whole arm by a metre
/// along x, y and z of the block's frame. The lengths of the place are at right angles only where axis 1
/// stands on the block's base, and where it is parallel to the block's z axis no length is along y: then the
/// two angles about these axes, turned against each other, displace it so.
Eigen::MatrixXd unit_displacements(const KinematicModel& nominal) {
  constexpr int kPostures = 4;  // three tips that are not in line tell a displacement from a turn
  const JointRanges ranges{JointVector::Constant(-1.0), JointVector::Constant(1.0)};
  std::vector<int> place;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    if (error_parameters()[static_cast<std::size_t>(i)].group() == ParameterGroup::kBlockPose)
      place.push_back(i);
  }
  Eigen::MatrixXd of_tips(3 * kPostures, std::ssize(place));
  Eigen::MatrixXd displaced(3 * kPostures, 3);
  const PreparedModel prepared = prepare(nominal);
  for (int i = 0; i < kPostures; ++i) {
    const Chain chain = forward_chain(prepared, halton_posture(i + 1, ranges));
    of_tips.middleRows<3>(3 * i) = tip_derivatives(nominal, chain)(Eigen::all, place);
    displaced.middleRows<3>(3 * i).setIdentity();
  }
  Eigen::MatrixXd of_arm = Eigen::MatrixXd::Zero(kArmParameterCount, 3);
  of_arm(place, Eigen::all) = pseudo_inverse(of_tips) * displaced;
  return of_arm;
}

/// Adds the drift, as a displacement of the arm: what is shown, and what the scatter of the reference touches
/// leaves open. No touch says in which direction, so that it is the same in each.
void add_drift(const IdentificationProblem& problem, SourceSum& sum, UncertaintyBudget& result) {
  const double open_m = problem.drift_uncertainty.std_m;
  if (problem.drift_m == 0.0 && open_m == 0.0) return;
  ArmCovariance& covariance = sum.source("drift").covariance;
  const Eigen::MatrixXd directions = unit_displacements(problem.nominal) / 2.0;
  const ArmCovariance of_one_metre = directions * directions.transpose();
  result.of_drift = open_m * open_m * of_one_metre;
  result.drift_degrees_of_freedom = problem.drift_uncertainty.degrees_of_freedom;
  covariance += problem.drift_m * problem.drift_m * of_one_metre + result.of_drift;
  result.of_posture += covariance;
}

/// The parameters of the artefact without a prior that an error of unknown size displaces are unknown as
/// well.
void displace_by_unknown(const Artefact& artefact, const Eigen::VectorXd& direction,
                         Eigen::VectorXd& artefact_std) {
  constexpr double kDisplacedMin = 1e-3;  // metres or radians per metre or radian
  for (const int index : parameters_without_prior(artefact)) {
    if (std::abs(direction[kArmParameterCount + index]) > kDisplacedMin)
      artefact_std[index] = std::numeric_limits<double>::quiet_NaN();
  }
}

/// Adds to the artefact's what was not estimated and displaces it along with the arm.
void displace_artefact(const Eigen::MatrixXd& by_one_std, Eigen::VectorXd& artefact_std) {
  const auto of_artefact = by_one_std.bottomRows(artefact_std.size());
  for (Eigen::Index k = 0; k < of_artefact.cols(); ++k)
    artefact_std = (artefact_std.cwiseAbs2() + of_artefact.col(k).cwiseAbs2()).cwiseSqrt();
}

/// Adds the errors that were not estimated: each is within its tolerance and biases the estimated ones.
void add_unseen(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                const LeastSquares& fit, const FullLinearisation& whole, SourceSum& sum,
                UncertaintyBudget& result) {
  std::vector<Eigen::VectorXd> unknown;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    if (is_estimated(fit, column)) continue;
    const CandidateStatus& candidate = identifiable.candidates[static_cast<std::size_t>(column)];
    const bool is_held =
        candidate.status == ParameterStatus::kWeak || candidate.status == ParameterStatus::kExcluded;
    if (const auto tolerance = std_unless_estimated(problem, column, result.harmonic_shares)) {
      const Eigen::VectorXd displacement = *tolerance * bias_direction(whole, column);
      if (is_held && *tolerance > 0.0) {
        add_held("held", displacement, sum, result);
      } else {
        add_square(displacement, result.unseen);
        add_left_out(displacement, result);
      }
    } else {
      result.unseen_without_tolerance.push_back(column);
      const Eigen::VectorXd direction = unseen_direction(problem, candidate, fit, whole, column);
      unknown.push_back(direction);
      displace_by_unknown(problem.artefact, direction, result.artefact_std);
    }
  }
  result.unknown_directions.resize(kArmParameterCount, static_cast<Eigen::Index>(unknown.size()));
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    result.unknown_directions.col(static_cast<Eigen::Index>(i)) = unknown[i].head<kArmParameterCount>();
  }
  sum.append("unseen", result.unseen);
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

void add_unfitted(const IdentificationProblem& problem, const IdentifiableSet& identifiable,
                  const LeastSquares& fit, const FullLinearisation& whole, UncertaintyBudget& fitted) {
  SourceSum sum(fit.arm_columns(), std::move(fitted.sources));
  fitted.left_out.resize(whole.touch_information.rows(), 0);
  add_unseen(problem, identifiable, fit, whole, sum, fitted);
  add_nongeometric(problem, fit, whole, sum, fitted);
  add_patterns(whole, sum, fitted);
  add_gears(problem, fit, sum, fitted);
  add_drift(problem, sum, fitted);
  displace_artefact(fitted.left_out, fitted.artefact_std);
  displace_artefact(fitted.patterned, fitted.artefact_std);
  fitted.sources = sum.take();
  fitted.correlations = strongest(fitted.identified, fit.arm_columns());
}

}  // namespace calib
