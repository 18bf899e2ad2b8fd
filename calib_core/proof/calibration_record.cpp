#include "calib_core/proof/calibration_record.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/identification/model_selection.hpp"

namespace calib {
namespace {

std::vector<std::size_t> fitted_touches(const IdentificationProblem& problem,
                                        const IdentificationResult& result) {
  std::vector<std::size_t> fitted;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    const bool is_rejected =
        std::ranges::find(result.rejected, i, &RejectedTouch::touch) != result.rejected.end();
    if (problem.touches[i].role == TouchRole::kFit && !is_rejected) fitted.push_back(i);
  }
  return fitted;
}

/// d distance / d position of each joint, a row per touch, metres per radian. The columns of `fit` begin with
/// the candidates.
Eigen::MatrixXd joint_levers(const IdentificationProblem& problem, const LeastSquares& fit) {
  Eigen::MatrixXd per_rad(fit.rows().rows(), kJointCount);
  for (int joint = 0; joint < kJointCount; ++joint)
    per_rad.col(joint) = problem.nominal.gains[static_cast<std::size_t>(joint)] *
                         fit.rows().col(theta_index(joint)).cwiseQuotient(fit.weights());
  return per_rad;
}

/// Variances of a joint's position by the maker's figures, square radians.
struct GearFigures {
  JointVector ripple, scatter;  // what changes from posture to posture; that and the stops
};

/// Beside these columns of the arm, and without the play: a search takes it up in a known direction, so that
/// it is a pattern and no scatter.
GearFigures gear_figures(const IdentificationProblem& problem, const std::vector<int>& arm_columns) {
  // Of a play of width w the lag has the variance w^2 / 8; an even spread over it, as it is among the gears'
  // figures for motions of any direction, w^2 / 12.
  constexpr double kSpreadOfLag = 8.0 / 12.0;
  const JointVector play = kSpreadOfLag * problem.gear_lag_std_rad.cwiseAbs2();
  const JointVector scatter = (gear_std_beside(problem, arm_columns).cwiseAbs2() - play).cwiseMax(0.0);
  return {(scatter - problem.stop_std_rad.cwiseAbs2()).cwiseMax(0.0), scatter};
}

double mean_variance(const Eigen::MatrixXd& per_rad, const JointVector& joint_variances) {
  return (per_rad.cwiseAbs2() * joint_variances).mean();
}

/// What the test of the fit has, without what it counts twice: the stops are in the repeats already, and the
/// play is among the patterns. Repeats of `degrees` degrees of freedom that are a share q of a variance give
/// it degrees / q^2.
TouchNoise expected_noise(const LackOfFit& tested, double ripple_variance_m2) {
  const double variance = tested.noise_m * tested.noise_m;
  const double once = tested.repeats_m * tested.repeats_m + ripple_variance_m2;
  if (tested.repeats_m == 0.0 || once >= variance) return {tested.noise_m, tested.noise_degrees};
  return {std::sqrt(once), tested.noise_degrees * std::pow(once / variance, 2)};
}

/// What the residuals say of how much of the noise grows with the levers: the mean after the touches of a
/// share q of the most that may, before them any in (0, 1) alike. Touch i has a variance in proportion to
/// 1 - q most + q of_joints_i, and what the fit leaves of its residual 1 - leverage of that; of the noise
/// itself every magnitude is alike.
double mean_lever_share(const Eigen::VectorXd& of_joints, double most, LeastSquares& fit) {
  constexpr int kShareSteps = 32;
  const Eigen::ArrayXd left = (1.0 - fit.leverages().array()).cwiseMax(0.0);
  const Eigen::ArrayXd squares = (fit.residuals_m().array() / fit.noise_factors().array()).square();
  Eigen::ArrayXd shares(kShareSteps), logs(kShareSteps);
  for (int k = 0; k < kShareSteps; ++k) {
    shares[k] = (k + 0.5) / kShareSteps;
    const Eigen::ArrayXd variances = 1.0 - shares[k] * most + shares[k] * of_joints.array();
    logs[k] =
        -0.5 * (left * variances.log()).sum() - 0.5 * left.sum() * std::log((squares / variances).sum());
  }
  const Eigen::ArrayXd weights = (logs - logs.maxCoeff()).exp();
  return (weights * shares).sum() / weights.sum();
}

/// Rows times displacements of touches by one unit of growth, even from the first to the last; as the columns
/// of the whole linearisation.
Eigen::VectorXd growth_in_run(const LeastSquares& everything, const FullLinearisation& whole,
                              const KinematicModel& calibrated) {
  const ArmVector grown = errors_by_growth(calibrated, 1.0);
  const Eigen::VectorXd weighted =
      everything.rows().leftCols(std::ssize(whole.columns)) * grown(whole.columns);
  const Eigen::VectorXd since_middle = Eigen::VectorXd::LinSpaced(weighted.size(), -0.5, 0.5);
  const Eigen::VectorXd of_columns = everything.rows().transpose() * weighted.cwiseProduct(since_middle);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(whole.touch_information.rows());
  for (Eigen::Index k = 0; k < of_columns.size(); ++k) gradient[whole.position_of(k)] = of_columns[k];
  return gradient;
}

}  // namespace

CalibrationRecord::CalibrationRecord(const IdentificationProblem& problem,
                                     const IdentificationOptions& options, const IdentificationResult& result)
    : problem_(problem),
      options_(settled_options(options, result)),
      calibrated_(result.calibrated),
      errors_(result.errors),
      artefact_errors_(result.artefact_errors) {
  if (result.status != IdentificationStatus::kConverged || !result.uncertainty)
    throw std::logic_error("only a calibration that has converged can be proved or checked");
  if (result.weight_noise_m > 0.0) assume_noise(problem_, result.weight_noise_m);
  LeastSquares fit(problem_, options_, estimated_columns(problem_, options_, result.identifiable),
                   fitted_touches(problem, result));
  const Estimate estimate{result.errors, result.artefact_errors};
  fit.linearise(estimate);
  if (!fit.solve()) throw std::logic_error("the touches of the calibration do not determine its result");
  whole_ = linearise_all_parameters(problem_, options_, fit, estimate);
  LeastSquares everything(fit, options_, whole_.columns);
  everything.linearise(estimate);
  const Eigen::MatrixXd per_rad = joint_levers(problem_, everything);
  const GearFigures gears = gear_figures(problem_, fit.arm_columns());
  noise_ = {result.uncertainty->noise_m, result.uncertainty->degrees_of_freedom};
  if (result.lack_of_fit) {
    const TouchNoise expected = expected_noise(*result.lack_of_fit, mean_variance(per_rad, gears.ripple));
    if (expected.std_m < noise_.std_m) noise_ = expected;
  }
  share_noise(gears.scatter, per_rad, fit);
  Eigen::MatrixXd scattered = fit.rows();
  for (Eigen::Index row = 0; row < scattered.rows(); ++row)
    scattered.row(row) *=
        fit.weights()[row] * std::sqrt(noise_variance_m2(per_rad.row(row), fit.noise_factors()[row]));
  bent_by_growth_ = bent_by(growth_in_run(everything, whole_, calibrated_));
  const Eigen::MatrixXd of_noise = scattered.transpose() * scattered;
  scatter_.setZero(unknown_count(), unknown_count());
  scatter_(whole_.estimated, whole_.estimated) =
      whole_.estimated_covariance * of_noise * whole_.estimated_covariance;
  covariance_ = joint_covariance(of_noise);
  problem_.touches.clear();
}

void CalibrationRecord::share_noise(const JointVector& gear_variances, const Eigen::MatrixXd& per_rad,
                                    LeastSquares& fit) {
  const double variance = noise_.std_m * noise_.std_m;
  const Eigen::VectorXd of_figures = per_rad.cwiseAbs2() * gear_variances;
  const double mean = of_figures.mean();
  const double most = std::min(1.0, mean / variance);
  const double share = most > 0.0 ? most * mean_lever_share(most * of_figures / mean, most, fit) : 0.0;
  alike_variance_m2_ = (1.0 - share) * variance;
  if (share > 0.0) joint_variances_rad2_ = share * variance / mean * gear_variances;
}

double CalibrationRecord::noise_variance_m2(const JointVector& per_rad, double factor) const {
  return factor * factor * (alike_variance_m2_ + per_rad.cwiseAbs2().dot(joint_variances_rad2_));
}

void CalibrationRecord::meet_at(std::vector<ContactSurface> contact_planes) {
  if (contact_planes.size() != problem_.artefact.contact_planes.size())
    throw std::logic_error("a surface for each face is required");
  problem_.artefact.contact_planes = std::move(contact_planes);
}

bool CalibrationRecord::is_estimated(int arm_column) const {
  return std::ranges::binary_search(whole_.estimated, arm_column);
}

Eigen::VectorXd CalibrationRecord::bent_by(const Eigen::VectorXd& of_columns) const {
  Eigen::VectorXd bent = Eigen::VectorXd::Zero(unknown_count());
  bent(whole_.estimated) = -whole_.estimated_covariance * of_columns(whole_.estimated);
  return bent;
}

Eigen::VectorXd CalibrationRecord::displacement_by(int arm_column) const {
  Eigen::VectorXd displaced = bent_by(whole_.touch_information.col(arm_column));
  displaced[arm_column] += 1.0;
  return displaced;
}

Eigen::VectorXd CalibrationRecord::displacement_by_pattern(Eigen::Index pattern) const {
  Eigen::VectorXd displaced = bent_by(whole_.pattern_columns.col(pattern));
  displaced[whole_.touch_information.rows() + pattern] = 1.0;
  return whole_.patterns[static_cast<std::size_t>(pattern)].std * displaced;
}

Eigen::MatrixXd CalibrationRecord::repeated_displacements() const {
  Eigen::MatrixXd displaced = Eigen::MatrixXd::Zero(unknown_count(), unknown_count());
  const auto displace = [&](Eigen::Index unknown, const std::optional<double>& std) {
    if (!std) return;
    displaced.col(unknown) = *std * bent_by(whole_.touch_information.col(unknown));
    displaced(unknown, unknown) += *std;
  };
  for (int column = 0; column < kArmParameterCount; ++column)
    displace(column, std_unless_estimated(problem_, column, {1.0, 1.0}));
  const auto& of_artefact = problem_.artefact.parameters;
  for (std::size_t k = 0; k < of_artefact.size(); ++k)
    displace(kArmParameterCount + static_cast<Eigen::Index>(k), of_artefact[k].std);
  for (Eigen::Index k = 0; k < std::ssize(whole_.patterns); ++k)
    displaced.col(whole_.touch_information.rows() + k) = displacement_by_pattern(k);
  return displaced;
}

Eigen::MatrixXd CalibrationRecord::joint_covariance(const Eigen::MatrixXd& of_noise) const {
  const Eigen::MatrixXd& weighted = whole_.estimated_covariance;
  // The noise may differ from the one that weighed the touches against the priors.
  const Eigen::MatrixXd of_unit_noise =
      weighted * whole_.touch_information(whole_.estimated, whole_.estimated) * weighted;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(unknown_count(), unknown_count());
  covariance(whole_.estimated, whole_.estimated) = weighted - of_unit_noise + weighted * of_noise * weighted;
  for (int column = 0; column < kErrorParameterCount; ++column) {
    const auto& tolerance = problem_.tolerances[static_cast<std::size_t>(column)];
    if (!tolerance || is_estimated(column)) continue;
    const Eigen::VectorXd displaced = *tolerance * displacement_by(column);
    covariance += displaced * displaced.transpose();
  }
  for (Eigen::Index k = 0; k < std::ssize(whole_.patterns); ++k) {
    const Eigen::VectorXd displaced = displacement_by_pattern(k);
    covariance += displaced * displaced.transpose();
  }
  return covariance;
}

}  // namespace calib
