#include "calib_core/identification/monte_carlo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/estimation/least_squares.hpp"
#include "calib_core/identification/model_selection.hpp"
#include "calib_core/numerics/distributions.hpp"
#include "calib_core/numerics/uniform_chance.hpp"
#include "calib_core/uncertainty/left_out_effects.hpp"
#include "calib_core/uncertainty/tip_uncertainty.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

/// Numbers of draws are seeds from here on.
constexpr std::uint64_t kFirstSeed = 1'000'003;
/// Gauss-Newton from the fitted arm: what is left after a step of this size (metres and radians) is its
/// square, and 3e-4 of it where the arm is compliant: below a nanometre.
constexpr double kLastStepNorm = 1e-6;
/// A touch is moved onto its plane with the slope of the fitted arm: each step leaves about the share of the
/// distance that it moved the arm relative to its size. Two steps for 0.5 mm, four for 10 mm.
constexpr int kTouchStepsMax = 8;
constexpr double kOnFaceMetres = 1e-8;
constexpr double kSlopeMin = 1e-12;
constexpr double kQuantile = 0.95;

/// A normal deviate (Box and Muller).
double standard_normal(UniformChance& chance) {
  const double radius = std::sqrt(-2.0 * std::log1p(-chance()));
  return radius * std::cos(2.0 * std::numbers::pi * chance());
}

double mean_square(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

std::vector<PreparedJoints> prepare_all(const KinematicModel& model,
                                        const std::vector<JointVector>& postures) {
  std::vector<PreparedJoints> prepared;
  prepared.reserve(postures.size());
  for (const JointVector& joints : postures) prepared.push_back(prepare(model.gains, joints));
  return prepared;
}

/// d tip / d error of each joint's position, transposed: six rows a posture.
Eigen::MatrixX3d derive_by_joints(const TipPostures& postures) {
  Eigen::MatrixX3d by_joint(kJointCount * postures.count(), 3);
  for (int joint = 0; joint < kJointCount; ++joint) {
    for (int i = 0; i < postures.count(); ++i) {
      by_joint.row(kJointCount * i + joint) =
          postures.derivatives.block<3, 1>(3 * i, theta_index(joint)).transpose();
    }
  }
  return by_joint;
}

/// The smallest displacement of the joints that takes the ball one metre along the outward normal.
JointVector joints_per_metre(const KinematicModel& arm, const Chain& chain, const BallContact& contact) {
  const Eigen::Matrix<double, 1, kJointCount> slope =
      contact.normal.transpose() * point_jacobian(arm, chain, contact.ball_m);
  const double squared = slope.squaredNorm();
  if (squared < kSlopeMin) return JointVector::Zero();
  return slope.transpose() / squared;
}

struct Fitted {
  bool converged = false;
  Estimate estimate;
};

/// Gauss-Newton without condition numbers and history, from the start of the problem.
Fitted fit_again(const IdentificationProblem& problem, const IdentificationOptions& options,
                 const std::vector<int>& columns) {
  std::vector<std::size_t> touches(problem.touches.size());
  for (std::size_t i = 0; i < touches.size(); ++i) touches[i] = i;
  LeastSquares fit(problem, options, columns, std::move(touches));
  Fitted result{.estimate = {problem.start, Eigen::VectorXd::Zero(std::ssize(problem.artefact.parameters))}};
  for (int i = 0; i < options.iterations_max; ++i) {
    fit.linearise(result.estimate);
    if (!fit.solve()) return result;
    result.estimate = fit.stepped(std::move(result.estimate));
    result.converged = fit.arm_step_norm() < kLastStepNorm;
    if (result.converged) return result;
  }
  return result;
}

std::string words_of_failures(const MonteCarloFigures& figures) {
  return std::to_string(figures.count - figures.converged) + " of " + std::to_string(figures.count) +
         " simulated calibrations did not converge; the Monte Carlo figures are those of the others";
}

std::string words_of_difference(const MonteCarloFigures& figures) {
  const double ratio = figures.linear_over_monte_carlo.value();
  const auto percent = std::lround(100.0 * std::abs(ratio - 1.0));
  return "the linear uncertainty of the tip in the workspace box is " + std::to_string(percent) +
         (ratio < 1.0 ? " % smaller" : " % larger") + " than that of " + std::to_string(figures.converged) +
         " simulated calibrations; rely on the Monte Carlo figures";
}

}  // namespace

MonteCarlo::MonteCarlo(const IdentificationProblem& problem, const IdentificationOptions& options,
                       const IdentificationResult& result, std::span<const std::size_t> fitted,
                       MonteCarloPostures postures)
    : problem_(problem),
      options_(settled_options(options, result)),
      columns_(estimated_columns(problem, options_, result.identifiable)),
      fitted_arm_(result.errors),
      fitted_artefact_(result.artefact_errors),
      noise_m_(result.uncertainty.value().noise_m) {
  problem_.gear_std_rad = std::sqrt(result.uncertainty->gear_share) * gear_std_beside(problem, columns_);
  problem_.touches.clear();
  for (const std::size_t touch : fitted) problem_.touches.push_back(problem.touches[touch]);
  assume_noise(problem_, result.weight_noise_m);
  sideways_shapes_.resize(std::ssize(problem_.touches), 3);
  for (std::size_t i = 0; i < problem_.touches.size(); ++i) {
    const Touch& touch = problem_.touches[i];
    const Chain chain = forward_chain(result.calibrated, touch.joints);
    const BallContact contact = contact_at(
        problem.artefact.contact_planes[static_cast<std::size_t>(touch.face)], chain.block_from_frame.back());
    joints_per_metre_.push_back(joints_per_metre(result.calibrated, chain, contact));
    search_directions_.push_back(search_directions(result.calibrated, chain, contact.normal));
    sideways_shapes_.row(static_cast<Eigen::Index>(i)) = sideways_shapes(contact.push).transpose();
  }
  const Eigen::VectorXd precision = prior_precision(problem, columns_, options_.prior);
  prior_std_ = (precision.array() > 0.0).select(precision.cwiseSqrt().cwiseInverse(), 0.0);
  for (int column = 0; column < kArmParameterCount; ++column) {
    if (std::ranges::find(columns_, column) != columns_.end()) continue;
    if (const auto std = std_unless_estimated(problem, column, result.uncertainty->harmonic_shares))
      not_estimated_.emplace_back(column, *std);
  }
  const TipPostures box = derive_at_postures(problem.nominal, postures.box);
  box_ = {prepare_all(problem.nominal, postures.box), derive_by_joints(box)};
  joint_ranges_ = {prepare_all(problem.nominal, postures.joint_ranges),
                   derive_by_joints(derive_at_postures(problem.nominal, postures.joint_ranges))};
  linear_box_rms_m_ = box.region().rms_m(result.uncertainty->covariance());
}

MonteCarlo::Truth MonteCarlo::draw_truth(UniformChance& chance) const {
  Truth truth{fitted_arm_, fitted_artefact_, JointVector::Zero()};
  for (int joint = 0; joint < kJointCount; ++joint)
    truth.lag_rad[joint] = problem_.gear_lag_std_rad[joint] * standard_normal(chance);
  for (Eigen::Index k = 0; k < truth.sideways_m.size(); ++k) {
    const double std_m = problem_.artefact.std_sideways_m[k];
    if (std_m > 0.0) truth.sideways_m[k] = std_m * standard_normal(chance);
  }
  for (const auto& [column, std] : not_estimated_) truth.arm[column] = std * standard_normal(chance);
  // Half of what the place moved in the run, as the budget has it, in any direction.
  for (const double moved_m : {problem_.drift_m, problem_.drift_uncertainty.std_m}) {
    if (moved_m == 0.0) continue;
    for (double& along_m : truth.drifted_m) along_m += moved_m / 2.0 * standard_normal(chance);
  }
  return truth;
}

/// What is given is the truth with an error. The prior of an error is around 0: the nominal arm and artefact
/// are moved to what is given, and all errors count from there.
IdentificationProblem MonteCarlo::draw_problem(const Truth& truth, UniformChance& chance) const {
  IdentificationProblem drawn = problem_;
  ArmVector given = ArmVector::Zero();
  Eigen::Index k = 0;
  for (const int column : columns_) {
    const double std = prior_std_[k++];
    if (std > 0.0) given[column] = truth.arm[column] + std * standard_normal(chance);
  }
  Eigen::VectorXd given_artefact = truth.artefact;  // a face that is estimated in place: no prior
  for (Eigen::Index i = 0; i < given_artefact.size(); ++i)
    given_artefact[i] += prior_std_[k++] * standard_normal(chance);
  drawn.nominal = apply(problem_.nominal, given);
  drawn.start = fitted_arm_ - given;
  correct_contact_planes(problem_.artefact, given_artefact, drawn.artefact.contact_planes);
  for (ArtefactEquation& equation : drawn.artefact.equations) {
    equation.value_m = equation.std_m * standard_normal(chance);
    for (const auto& [index, weight] : equation.weights)
      equation.value_m += weight * (truth.artefact[index] - given_artefact[index]);
  }

  const PreparedModel arm = prepare(apply(problem_.nominal, truth.arm));
  std::vector<ContactSurface> planes;
  correct_contact_planes(problem_.artefact, truth.artefact, planes);
  for (std::size_t i = 0; i < drawn.touches.size(); ++i) {
    Touch& touch = drawn.touches[i];
    const ContactSurface& plane = planes[static_cast<std::size_t>(touch.face)];
    const double off_m = noise_m_ * noise_factor(touch, problem_.touch_noise_m) * standard_normal(chance) -
                         sideways_shapes_.row(static_cast<Eigen::Index>(i)).dot(truth.sideways_m);
    for (int step = 0; step < kTouchStepsMax; ++step) {
      const double beside_m =
          signed_distance_m(plane, forward_chain(arm, touch.joints).block_from_frame.back()) - off_m;
      if (std::abs(beside_m) < kOnFaceMetres) break;
      touch.joints -= beside_m * joints_per_metre_[i];
    }
    touch.joints += truth.lag_rad.cwiseProduct(search_directions_[i]);  // the drive is ahead
  }
  return drawn;
}

std::vector<double> MonteCarlo::tip_errors_m(const Region& region, const Truth& truth,
                                             const PreparedModel& true_arm, const PreparedModel& calibrated,
                                             UniformChance& chance) const {
  const bool has_gears = !problem_.gear_std_rad.isZero(0.0);
  std::vector<double> errors_m;
  errors_m.reserve(region.postures.size());
  Eigen::Index row = 0;
  for (const PreparedJoints& joints : region.postures) {
    Eigen::Vector3d off_m = truth.drifted_m + forward_chain(true_arm, joints).tip_in_block_m() -
                            forward_chain(calibrated, joints).tip_in_block_m();
    JointVector off_rad;
    for (int joint = 0; has_gears && joint < kJointCount; ++joint)
      off_rad[joint] = problem_.gear_std_rad[joint] * standard_normal(chance);
    if (has_gears) off_m += region.by_joint.middleRows<kJointCount>(row).transpose() * off_rad;
    row += kJointCount;
    errors_m.push_back(off_m.norm());
  }
  return errors_m;
}

MonteCarloDraw MonteCarlo::draw(std::uint64_t number) const {
  UniformChance chance(kFirstSeed + number);
  const Truth truth = draw_truth(chance);
  const IdentificationProblem drawn = draw_problem(truth, chance);
  const Fitted fitted = fit_again(drawn, options_, columns_);
  if (!fitted.converged) return {};
  const PreparedModel true_arm = prepare(apply(problem_.nominal, truth.arm));
  const PreparedModel calibrated = prepare(apply(drawn.nominal, fitted.estimate.arm));
  const std::vector<double> in_box_m = tip_errors_m(box_, truth, true_arm, calibrated, chance);
  const std::vector<double> over_ranges_m = tip_errors_m(joint_ranges_, truth, true_arm, calibrated, chance);
  return {.converged = true,
          .box_mean_square_m2 = mean_square(in_box_m),
          .joint_ranges_mean_square_m2 = mean_square(over_ranges_m),
          .tip_error_m = in_box_m.empty() ? 0.0 : in_box_m[number % in_box_m.size()]};
}

MonteCarloFigures figures_of(std::span<const MonteCarloDraw> draws, std::optional<double> linear_box_rms_m) {
  MonteCarloFigures figures{.count = static_cast<int>(draws.size())};
  double box = 0.0, box_squares = 0.0, ranges = 0.0;
  std::vector<double> tip_errors_m;
  for (const MonteCarloDraw& draw : draws) {
    if (!draw.converged) continue;
    box += draw.box_mean_square_m2;
    box_squares += draw.box_mean_square_m2 * draw.box_mean_square_m2;
    ranges += draw.joint_ranges_mean_square_m2;
    tip_errors_m.push_back(draw.tip_error_m);
  }
  figures.converged = static_cast<int>(tip_errors_m.size());
  if (figures.converged < figures.count) figures.warning = words_of_failures(figures);
  if (figures.converged < 2) return figures;
  const double count = figures.converged;
  figures.joint_ranges_rms_m = std::sqrt(ranges / count);
  if (!linear_box_rms_m || !(box > 0.0)) return figures;
  const double mean = box / count;
  figures.box_rms_m = std::sqrt(mean);
  figures.box_p95_m = sample_quantile(std::move(tip_errors_m), kQuantile);
  const double ratio = *linear_box_rms_m / *figures.box_rms_m;
  figures.linear_over_monte_carlo = ratio;
  // The root has half the relative standard deviation of the mean square.
  const double variance = std::max(0.0, box_squares / count - mean * mean) * count / (count - 1.0);
  const double scatter = 0.5 * std::sqrt(variance / count) / mean;
  const double off = std::abs(ratio - 1.0);
  if (off > kLinearShareMax && off > kMonteCarloSigmas * scatter * ratio)
    figures.warning += (figures.warning.empty() ? "" : "; ") + words_of_difference(figures);
  return figures;
}

}  // namespace calib
