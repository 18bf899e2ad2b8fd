#include "calib_core/identification/identify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/estimation/gauss_newton.hpp"
#include "calib_core/estimation/input_check.hpp"
#include "calib_core/estimation/outlier_rejection.hpp"
#include "calib_core/identification/face_distances.hpp"
#include "calib_core/identification/held_places.hpp"
#include "calib_core/identification/model_selection.hpp"
#include "calib_core/identification/model_trial.hpp"
#include "calib_core/identification/result_warnings.hpp"
#include "calib_core/numerics/condition_number.hpp"
#include "calib_core/uncertainty/distance_uncertainty.hpp"
#include "calib_core/uncertainty/residual_evidence.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

/// How many parameters the touches determine, however weakly: several may share one weak direction.
int count_with_weak(const IdentificationProblem& problem, IdentificationOptions options,
                    const std::vector<std::size_t>& touches) {
  options.hold_weak = false;
  options.identifiability.qr_tolerance.reset();
  return static_cast<int>(choose_columns(problem, options, touches).columns.size());
}

void refuse(IdentificationResult& result, InputRefusal refusal) {
  result.status = refusal.status;
  result.message = std::move(refusal.message);
}

/// Lists the rejected touches, those of an earlier fit as well, with their residuals at the final arm.
void list_rejected(const IdentificationProblem& problem, const LeastSquares& fit, const Estimate& estimate,
                   IdentificationResult& result) {
  for (std::size_t i = 0; i < fit.touches().size(); ++i) {
    if (!fit.kept()[i]) result.rejected.push_back({fit.touches()[i], 0.0, RejectionReason::kOutlier});
  }
  const KinematicModel arm = apply(problem.nominal, estimate.arm);
  std::vector<ContactSurface> planes;
  correct_contact_planes(problem.artefact, estimate.artefact, planes);
  for (RejectedTouch& rejected : result.rejected) {
    const Touch& touch = problem.touches[rejected.touch];
    rejected.residual_m = signed_distances_m(arm, planes, std::span(&touch, 1))[0];
  }
  std::ranges::sort(result.rejected, {}, &RejectedTouch::touch);
}

/// The identified parameter with the largest standard deviation relative to weak_std(), when it exceeds that.
/// The column choice cannot find it: later columns increase the uncertainty of earlier ones.
std::optional<int> weakest(const IdentificationResult& result) {
  std::optional<int> weakest;
  if (!result.uncertainty) return weakest;
  double most = 1.0;
  for (const int column : result.identifiable.columns) {
    const double limit = weak_std(error_parameters()[static_cast<std::size_t>(column)]);
    const double share = std::sqrt(result.uncertainty->identified(column, column)) / limit;
    if (share <= most) continue;
    most = share;
    weakest = column;
  }
  return weakest;
}

bool may_hold(const IdentificationProblem& problem, const IdentificationOptions& options) {
  return options.hold_weak && !options.prior && !problem.columns;
}

/// Whether another solution follows this one, which is evaluated in part.
bool is_followed(const IdentificationProblem& problem, const IdentificationOptions& options,
                 const IdentificationResult& result) {
  return (may_hold(problem, options) && weakest(result)) || !against_harmonics(problem, options, result) ||
         !against_ripple(problem, options, result) || is_reweighed(problem, options, result);
}

/// kFit: what decides between solutions: goodness of fit, measured noise, uncertainty of what was fitted.
/// kAll: also distances, uncertainty of what was not fitted, scale check.
enum class Extent { kFit, kAll };

/// Evaluates a converged identification, in part when another solution follows it in any case.
void evaluate(const IdentificationProblem& problem, const IdentificationOptions& options,
              double declared_noise_m, Extent extent, LeastSquares& fit, const Estimate& estimate,
              IdentificationResult& result) {
  result.noise_estimated_m = estimated_noise_m(fit, estimate);
  result.is_declared_noise_too_large = is_declared_too_large(problem, fit, estimate);
  if (problem.touch_noise_m <= 0.0 && !result.noise_estimated_m) {  // no noise to propagate
    result.distances = face_distances(problem, result);
    return;
  }
  const Eigen::MatrixXd covariance = inverse_information(fit.information());
  result.residual_sum = residual_sum(fit, covariance);
  const ExpectedNoise expected{repeat_noise(declared_noise_m, problem.pure_error), result.gear_variance_m2};
  result.lack_of_fit = lack_of_fit(problem, fit, estimate, result.residual_sum, expected);
  const TouchNoise of_residuals = measured_noise(0.0, result.residual_sum, fit.noise_unit_m());
  const double gear_share = mean_gear_share({of_residuals, expected.repeats, expected.gear_variance_m2});
  // What repeats and gears make of a touch is known better than what was declared.
  const double prior_m = problem.pure_error ? std::hypot(expected.repeats.std_m,
                                                         std::sqrt(gear_share * expected.gear_variance_m2))
                                            : declared_noise_m;
  const TouchNoise noise = options.measure_noise
                               ? measured_noise(prior_m, result.residual_sum, fit.noise_unit_m())
                               : TouchNoise{declared_noise_m, std::numeric_limits<double>::infinity()};
  result.uncertainty = fitted_uncertainty(problem, options, fit, covariance, noise);
  if (extent == Extent::kFit && is_followed(problem, options, result)) return;
  result.distances = face_distances(problem, result);
  FullLinearisation whole = linearise_all_parameters(problem, options, fit, estimate, covariance);
  whole.noise = {.squares = fit.chi_square(estimate),
                 .degrees = static_cast<double>(fit.degrees_of_freedom()),
                 .otherwise = std::pow(noise.std_m / fit.noise_unit_m(), 2)};
  if (result.lack_of_fit) result.lack_of_fit->droop = test_droop(problem, fit, whole, result.residual_sum);
  result.uncertainty->gear_share = gear_share;
  add_unfitted(problem, result.identifiable, fit, whole, *result.uncertainty);
  result.scale = check_scale(problem, options, fit, whole, *result.uncertainty, estimate);
  for (FaceDistances& distances : result.distances) {
    if (distances.role == TouchRole::kFit) continue;
    distances.calibrated_mean_std_m =
        mean_distance_std_m(problem, fit, whole, *result.uncertainty, estimate,
                            touches_of(problem, result, distances.role, distances.face));
  }
}

/// The noise of `problem` weighs the touches; `declared_noise_m` is what is said of it.
void solve(const IdentificationProblem& problem, const IdentificationOptions& options,
           double declared_noise_m, const std::vector<std::size_t>& fitted, IdentificationResult& result) {
  LeastSquares fit(problem, options, estimated_columns(problem, options, result.identifiable), fitted);
  if (const JointVector beside = gear_std_beside(problem, fit.arm_columns()); beside != problem.gear_std_rad)
    result.gear_variance_m2 = gear_variance_m2(problem, beside, fitted);
  GaussNewton iteration(problem, options, fit, result.identifiable.columns);
  Estimate estimate = iteration.start();
  if (auto refusal = find_unconstrained(problem, options, fit, estimate)) {
    refuse(result, std::move(*refusal));
    return;
  }
  bool converged = iteration.run(estimate, true);
  const bool all_converged = converged;
  if (options.robust && iteration.solvable()) {
    OutlierRejection rejection(problem, fit, iteration);
    if (!converged || !rejection.is_consistent()) {
      rejection.run(result.identifiable.columns);
      estimate = iteration.start();
      converged = iteration.run(estimate, true);
    }
  }
  result.iterations = iteration.history();
  result.fitted_touch_count = fit.kept_count();
  list_rejected(problem, fit, estimate, result);
  if (!converged) {
    result.status = iteration.solvable() && options.prior && iteration.history().empty()
                        ? IdentificationStatus::kSingularPrior
                        : IdentificationStatus::kNotConverged;
    result.message = iteration.message();
    if (all_converged) {
      result.status = IdentificationStatus::kContradictory;
      result.message = "no half of the " + std::to_string(fitted.size()) +
                       " touches is consistent with one arm (" + iteration.message() +
                       "); check planes, block and probe, and touch again";
    }
    return;
  }
  const auto total = static_cast<int>(fitted.size());
  if (2 * fit.kept_count() < total ||
      (!options.prior && fit.kept_count() < std::ssize(result.identifiable.columns))) {
    result.status = IdentificationStatus::kContradictory;
    result.message = std::to_string(total - fit.kept_count()) + " of " + std::to_string(total) +
                     " touches do not fit the others; check planes, block and probe, and touch again";
    return;
  }
  result.status = IdentificationStatus::kConverged;
  result.weight_noise_m = problem.touch_noise_m;
  result.errors = estimate.arm;
  result.artefact_errors = estimate.artefact;
  result.calibrated = apply(problem.nominal, estimate.arm);
  for (const int column : fit.arm_columns()) {
    if (column >= kErrorParameterCount) result.nongeometric.push_back(column - kErrorParameterCount);
  }
  evaluate(problem, options, declared_noise_m, Extent::kFit, fit, estimate, result);
}

InputRefusal nothing_identifiable(std::size_t touch_count) {
  return {IdentificationStatus::kUnobservable, "these " + std::to_string(touch_count) +
                                                   " touches determine none of the parameters well enough "
                                                   "for the declared noise; spread them over faces, "
                                                   "postures and tilts"};
}

std::vector<std::size_t> without(std::vector<std::size_t> touches,
                                 const std::vector<RejectedTouch>& rejected) {
  std::erase_if(touches, [&](std::size_t touch) {
    return std::ranges::find(rejected, touch, &RejectedTouch::touch) != rejected.end();
  });
  return touches;
}

/// The result before a solution of the same touches by another model or weight: what the first one chose and
/// rejected stays.
IdentificationResult before_another(const IdentificationResult& before, const IdentificationResult& first) {
  IdentificationResult result = before;
  result.identifiable = first.identifiable;
  result.rejected = first.rejected;
  return result;
}

/// Solves, then holds the weakest parameter at nominal and solves again until none is too weak. `before` is
/// the result before the first solution.
IdentificationResult solve_and_hold(const IdentificationProblem& problem,
                                    const IdentificationOptions& options, double declared_noise_m,
                                    const std::vector<std::size_t>& fitted,
                                    const IdentificationResult& before) {
  IdentificationResult result = before;
  solve(problem, options, declared_noise_m, fitted, result);
  IdentificationOptions settled = options;  // the outliers are known from the first solution
  settled.robust = false;
  while (result.status == IdentificationStatus::kConverged) {
    const auto weak = may_hold(problem, options) ? weakest(result) : std::nullopt;
    if (!weak) break;
    IdentificationResult next = before_another(before, result);
    std::erase(next.identifiable.columns, *weak);
    next.identifiable.candidates[static_cast<std::size_t>(*weak)].status = ParameterStatus::kWeak;
    if (next.identifiable.columns.empty()) {
      refuse(next, nothing_identifiable(fitted.size()));
      return next;
    }
    solve(problem, settled, declared_noise_m, without(fitted, result.rejected), next);
    result = std::move(next);
  }
  return result;
}

/// solve_and_hold(), and what is to be tried beside it by the same touches.
IdentificationResult solve_and_select(const IdentificationProblem& problem,
                                      const IdentificationOptions& options,
                                      const std::vector<std::size_t>& fitted,
                                      const IdentificationResult& before) {
  const auto solve_again = [&](const IdentificationOptions& with_more, const IdentificationResult& first) {
    return solve_and_hold(problem, with_more, problem.touch_noise_m, without(fitted, first.rejected),
                          before_another(before, first));
  };
  return select_model(problem, options, fitted,
                      solve_and_hold(problem, options, problem.touch_noise_m, fitted, before), solve_again);
}

/// Evaluates as a whole a solution that is taken although it was followed by another.
void complete(const IdentificationProblem& problem, const IdentificationOptions& options,
              double declared_noise_m, const std::vector<std::size_t>& fitted, IdentificationResult& result) {
  if (result.status != IdentificationStatus::kConverged || !result.distances.empty()) return;
  const IdentificationOptions settled = settled_options(options, result);
  LeastSquares fit(problem, settled, estimated_columns(problem, settled, result.identifiable),
                   without(fitted, result.rejected));
  const Estimate estimate{result.errors, result.artefact_errors};
  fit.linearise(estimate);
  if (fit.solve()) evaluate(problem, settled, declared_noise_m, Extent::kAll, fit, estimate, result);
}

/// The test stays that of the declared weights; the one for a droop is that of what was taken.
void keep_test(const IdentificationResult& declared, IdentificationResult& taken) {
  const std::optional<LackOfFit> of_taken = taken.lack_of_fit;
  taken.lack_of_fit = declared.lack_of_fit;
  taken.is_declared_noise_too_large = declared.is_declared_noise_too_large;
  taken.noise_estimated_m = declared.noise_estimated_m;
  if (taken.lack_of_fit && of_taken) taken.lack_of_fit->droop = of_taken->droop;
}

/// solve_and_select(), and where the touches are better or worse than declared once more with the noise that
/// was measured: a noise that is declared too large gives away what the touches say of block and ball.
IdentificationResult solve_and_weigh(const IdentificationProblem& problem,
                                     const IdentificationOptions& options,
                                     const std::vector<std::size_t>& fitted,
                                     const IdentificationResult& before) {
  IdentificationResult declared = solve_and_select(problem, options, fitted, before);
  if (!is_reweighed(problem, options, declared)) {
    complete(problem, options, problem.touch_noise_m, fitted, declared);
    return declared;
  }
  IdentificationProblem reweighed = problem;
  assume_noise(reweighed, declared.uncertainty->noise_m);
  const IdentificationOptions settled = settled_options(options, declared);
  IdentificationResult measured =
      solve_and_hold(reweighed, settled, problem.touch_noise_m, without(fitted, declared.rejected),
                     before_another(before, declared));
  if (measured.status != IdentificationStatus::kConverged) {
    complete(problem, options, problem.touch_noise_m, fitted, declared);
    return declared;
  }
  if (measured.identifiable.columns.size() < declared.identifiable.columns.size()) {
    // The noise was measured with a parameter that it makes too weak: once more without it.
    IdentificationOptions again = options;
    again.robust = false;
    return solve_and_weigh(problem, again, without(fitted, declared.rejected),
                           before_another(before, measured));
  }
  complete(reweighed, settled, problem.touch_noise_m, fitted, measured);
  keep_test(declared, measured);
  measured.model_reason = declared.model_reason;
  measured.warnings = declared.warnings;
  return measured;
}

/// Sets the identifiable columns: the given ones, or a choice.
void choose(const IdentificationProblem& problem, const IdentificationOptions& options,
            const std::vector<std::size_t>& fitted, IdentificationResult& result) {
  result.attainable =
      problem.attainable ? *problem.attainable : attainable_parameters(problem, options.identifiability);
  if (!problem.columns) {
    result.identifiable = choose_columns(problem, options, fitted);
    result.rank_explanation = explain_rank(problem, fitted, result.identifiable, result.attainable);
    return;
  }
  result.identifiable.columns = *problem.columns;
  for (const int column : *problem.columns) {
    result.identifiable.candidates[static_cast<std::size_t>(column)].status = ParameterStatus::kIdentified;
  }
}

/// Whether the touches are too few or determine too few parameters, after choose().
std::optional<InputRefusal> find_deficit(const IdentificationProblem& problem,
                                         const IdentificationOptions& options, const SortedTouches& sorted,
                                         const IdentificationResult& result) {
  if (options.prior) {
    if (!sorted.fitted.empty()) return std::nullopt;
    return InputRefusal{result.status, "0 touches: there is nothing to identify from"};
  }
  const int attainable = result.attainable.count;
  if (auto refusal = find_insufficient_data(problem, sorted.fitted, attainable)) {
    if (!sorted.wrong_face.empty()) {
      refusal->message += "; " + std::to_string(sorted.wrong_face.size()) +
                          " others are on another plane than stated; check the plane numbers";
    }
    return refusal;
  }
  const auto identified = static_cast<int>(result.identifiable.columns.size());
  if (identified == 0) return nothing_identifiable(sorted.fitted.size());
  if (!problem.columns && identified < attainable &&
      count_with_weak(problem, options, sorted.fitted) < attainable) {
    return InputRefusal{IdentificationStatus::kUnobservable, result.rank_explanation};
  }
  return std::nullopt;
}

/// The non-zero singular values of W at the nominal model.
std::vector<double> nominal_singular_values(const IdentificationProblem& problem,
                                            const IdentificationOptions& options,
                                            const std::vector<std::size_t>& fitted, int count) {
  std::vector<Touch> touches;
  for (const std::size_t index : fitted) touches.push_back(problem.touches[index]);
  Observation observation =
      observe(problem.nominal, problem.artefact.contact_planes, touches, options.formulation);
  weigh_rows(observation, touches, problem.touch_noise_m);
  const Eigen::VectorXd sigma = largest_singular_values(observation.matrix, count);
  return {sigma.begin(), sigma.end()};
}

IdentificationResult identify_touched(const IdentificationProblem& problem,
                                      const IdentificationOptions& options) {
  IdentificationResult result;
  result.calibrated = problem.nominal;
  if (auto refusal = find_invalid_input(problem, options)) {
    refuse(result, std::move(*refusal));
    return result;
  }
  SortedTouches sorted = sort_touches(problem, options);
  result.fitted_touch_count = static_cast<int>(sorted.fitted.size());
  result.rejected = sorted.wrong_face;
  if (sorted.refusal) {
    refuse(result, std::move(*sorted.refusal));
    return result;
  }
  choose(problem, options, sorted.fitted, result);
  auto refusal = find_deficit(problem, options, sorted, result);
  if (!refusal) refusal = find_one_sided_face(problem, sorted.fitted);
  if (refusal) {
    refuse(result, std::move(*refusal));
    return result;
  }
  const std::size_t chosen_count = result.identifiable.columns.size();
  result.singular_values =
      nominal_singular_values(problem, options, sorted.fitted, static_cast<int>(chosen_count));
  result.gear_variance_m2 = gear_variance_m2(problem, problem.gear_std_rad, sorted.fitted);
  result = solve_and_weigh(problem, options, sorted.fitted, result);
  add_warnings(problem, options, result);
  if (!problem.columns && result.identifiable.columns.size() < chosen_count) {
    result.singular_values.resize(result.identifiable.columns.size());
    result.rank_explanation = explain_rank(problem, sorted.fitted, result.identifiable, result.attainable);
  }
  if (result.status != IdentificationStatus::kConverged) result.distances = face_distances(problem, result);
  return result;
}

}  // namespace

IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options) {
  if (problem.artefact.face_count == 0) return identify_touched(problem, options);
  return identify_touched(with_held_places(problem), options);
}

}  // namespace calib
