#include "calib_core/identification/identify.hpp"

#include <algorithm>
#include <cmath>

#include "calib_core/estimation/column_choice.hpp"
#include "calib_core/estimation/gauss_newton.hpp"
#include "calib_core/estimation/input_check.hpp"
#include "calib_core/estimation/outlier_rejection.hpp"
#include "calib_core/identification/face_distances.hpp"
#include "calib_core/uncertainty/uncertainty_propagation.hpp"

namespace calib {
namespace {

/// How many parameters the touches show, however weakly: several of them may share one weak direction.
int shown_at_all(const IdentificationProblem& problem, IdentificationOptions options,
                 const std::vector<std::size_t>& touches) {
  options.hold_weak = false;
  options.identifiability.qr_tolerance.reset();
  return static_cast<int>(choose_columns(problem, options, touches).columns.size());
}

void refuse(IdentificationResult& result, Refusal refusal) {
  result.status = refusal.status;
  result.message = std::move(refusal.message);
}

/// Names what was left out, with its residual at the final arm.
void name_rejected(const IdentificationProblem& problem, const LeastSquares& fit, const Estimate& estimate,
                   IdentificationResult& result) {
  const KinematicModel arm = apply(problem.nominal, estimate.arm);
  for (std::size_t i = 0; i < fit.touches().size(); ++i) {
    if (fit.kept()[i]) continue;
    result.rejected.push_back(
        {fit.touches()[i], fit.residuals_m()[static_cast<Eigen::Index>(i)], RejectionReason::kOutlier});
  }
  for (RejectedTouch& rejected : result.rejected) {
    if (rejected.reason != RejectionReason::kWrongPlane) continue;
    const Touch& touch = problem.touches[rejected.touch];
    rejected.residual_m = signed_distances_m(arm, problem.artefact.contact_planes, std::span(&touch, 1))[0];
  }
  std::ranges::sort(result.rejected, {}, &RejectedTouch::touch);
}

void name_weak(IdentificationResult& result) {
  std::string names;
  for (int i = 0; i < kErrorParameterCount; ++i) {
    const auto& candidate = result.identifiable.candidates[static_cast<std::size_t>(i)];
    if (candidate.status != ParameterStatus::kWeak) continue;
    names += (names.empty() ? "" : ", ") + error_parameters()[static_cast<std::size_t>(i)].name();
  }
  if (names.empty()) return;
  result.warnings.push_back("held at nominal because these touches hardly show it: " + names +
                            "; spread the touches over more postures and tilts");
}

/// Everything that is said of a converged identification.
void assess(const IdentificationProblem& problem, const IdentificationOptions& options, LeastSquares& fit,
            const Estimate& estimate, IdentificationResult& result) {
  result.noise_estimated_m = estimated_noise_m(fit, estimate);
  result.lack_of_fit = lack_of_fit(problem, fit, estimate);
  if (problem.touch_noise_m <= 0.0 && !result.noise_estimated_m) return;  // nothing to be sure from
  const Linearisation whole = linearise_whole(options, fit, estimate);
  result.certainty =
      certainty(problem, options, result.identifiable, fit, whole, estimate, result.lack_of_fit);
  result.scale = check_scale(problem, options, fit, whole, *result.certainty, estimate);
}

void solve(const IdentificationProblem& problem, const IdentificationOptions& options,
           const std::vector<std::size_t>& fitted, IdentificationResult& result) {
  LeastSquares fit(problem, options, estimated_columns(options, result.identifiable), fitted);
  Iterations iterations(problem, options, fit, result.identifiable.columns);
  Estimate estimate = iterations.nominal();
  if (auto refusal = find_untold(problem, options, fit, estimate)) {
    refuse(result, std::move(*refusal));
    return;
  }
  bool converged = iterations.run(estimate, true);
  const bool all_converged = converged;
  if (options.robust && iterations.solvable()) {
    RobustSearch search(problem, fit, iterations);
    if (!converged || !search.nothing_suspect()) {
      search.run(result.identifiable.columns);
      estimate = iterations.nominal();
      converged = iterations.run(estimate, true);
    }
  }
  result.iterations = iterations.history();
  result.fitted_touch_count = fit.kept_count();
  name_rejected(problem, fit, estimate, result);
  if (!converged) {
    result.status = iterations.solvable() && options.prior && iterations.history().empty()
                        ? IdentificationStatus::kSingularPrior
                        : IdentificationStatus::kNotConverged;
    result.message = iterations.message();
    if (all_converged) {
      result.status = IdentificationStatus::kContradictory;
      result.message = "no half of the " + std::to_string(fitted.size()) + " touches agrees on an arm (" +
                       iterations.message() + "); check planes, block and probe, and touch again";
    }
    return;
  }
  const auto total = static_cast<int>(fitted.size());
  if (2 * fit.kept_count() < total || (!options.prior && fit.kept_count() < fit.arm_count())) {
    result.status = IdentificationStatus::kContradictory;
    result.message = std::to_string(total - fit.kept_count()) + " of " + std::to_string(total) +
                     " touches do not fit the others; check planes, block and probe, and touch again";
    return;
  }
  result.status = IdentificationStatus::kConverged;
  result.errors = estimate.arm;
  result.artefact_errors = estimate.artefact;
  result.calibrated = apply(problem.nominal, estimate.arm);
  assess(problem, options, fit, estimate, result);
}

/// The identified parameter that the touches leave least certain, when that is more than a weak one's
/// standard deviation: late columns make those before them uncertain, which the choice cannot see.
std::optional<int> weakest(const IdentificationResult& result) {
  std::optional<int> weakest;
  if (!result.certainty) return weakest;
  double most = 1.0;
  for (const int column : result.identifiable.columns) {
    const double limit = error_parameters()[static_cast<std::size_t>(column)].is_length() ? kWeakLengthMetres
                                                                                          : kWeakAngleRadians;
    const double share = std::sqrt(result.certainty->identified(column, column)) / limit;
    if (share <= most) continue;
    most = share;
    weakest = column;
  }
  return weakest;
}

Refusal nothing_shown(std::size_t touch_count) {
  return {IdentificationStatus::kUnobservable,
          "none of the parameters is shown by these " + std::to_string(touch_count) +
              " touches well enough for the declared noise; spread them over faces, postures and tilts"};
}

std::vector<std::size_t> without(std::vector<std::size_t> touches,
                                 const std::vector<RejectedTouch>& rejected) {
  std::erase_if(touches, [&](std::size_t touch) {
    return std::ranges::find(rejected, touch, &RejectedTouch::touch) != rejected.end();
  });
  return touches;
}

/// Solves; holds what comes out as a guess, one after the other, and solves again. `result` is taken as it is
/// before the first solution.
IdentificationResult solve_and_hold(const IdentificationProblem& problem,
                                    const IdentificationOptions& options,
                                    const std::vector<std::size_t>& fitted,
                                    const IdentificationResult& before) {
  const bool may_hold = options.hold_weak && !options.prior && !problem.columns;
  IdentificationResult result = before;
  solve(problem, options, fitted, result);
  IdentificationOptions settled = options;  // which touches belong together is known from the first solution
  settled.robust = false;
  while (result.status == IdentificationStatus::kConverged) {
    const auto guess = may_hold ? weakest(result) : std::nullopt;
    if (!guess) break;
    IdentificationResult next = before;
    next.identifiable = result.identifiable;
    std::erase(next.identifiable.columns, *guess);
    next.identifiable.candidates[static_cast<std::size_t>(*guess)].status = ParameterStatus::kWeak;
    next.rejected = result.rejected;
    if (next.identifiable.columns.empty()) {
      refuse(next, nothing_shown(fitted.size()));
      return next;
    }
    solve(problem, settled, without(fitted, result.rejected), next);
    result = std::move(next);
  }
  return result;
}

}  // namespace

IdentificationResult identify(const IdentificationProblem& problem, const IdentificationOptions& options) {
  IdentificationResult result;
  result.calibrated = problem.nominal;
  if (auto refusal = find_bad_input(problem, options)) {
    refuse(result, std::move(*refusal));
    return result;
  }
  Sorted sorted = sort_touches(problem, options);
  result.fitted_touch_count = static_cast<int>(sorted.fitted.size());
  result.rejected = sorted.wrong_plane;
  if (sorted.refusal) {
    refuse(result, std::move(*sorted.refusal));
    return result;
  }
  result.attainable =
      problem.attainable ? *problem.attainable : attainable_parameters(problem, options.identifiability);
  if (problem.columns) {
    result.identifiable.columns = *problem.columns;
    for (const int column : *problem.columns) {
      result.identifiable.candidates[static_cast<std::size_t>(column)].status = ParameterStatus::kIdentified;
    }
  } else {
    result.identifiable = choose_columns(problem, options, sorted.fitted);
    result.rank_explanation = explain_rank(problem, sorted.fitted, result.identifiable, result.attainable);
  }

  const auto shown = static_cast<int>(result.identifiable.columns.size());
  if (!options.prior) {
    if (auto refusal = find_too_little(problem, sorted.fitted, result.attainable.count)) {
      if (!sorted.wrong_plane.empty()) {
        refusal->message += "; " + std::to_string(sorted.wrong_plane.size()) +
                            " others are on another plane than their own, look at the planes' numbers";
      }
      refuse(result, std::move(*refusal));
      return result;
    }
    if (shown == 0) {
      refuse(result, nothing_shown(sorted.fitted.size()));
      return result;
    }
    if (!problem.columns && shown < result.attainable.count &&
        shown_at_all(problem, options, sorted.fitted) < result.attainable.count) {
      result.status = IdentificationStatus::kUnobservable;
      result.message = result.rank_explanation;
      return result;
    }
  } else if (sorted.fitted.empty()) {
    result.message = "0 touches: there is nothing to identify from";
    return result;
  }

  std::vector<Touch> touches;
  for (const std::size_t index : sorted.fitted) touches.push_back(problem.touches[index]);
  const Eigen::VectorXd sigma = largest_singular_values(
      observe(problem.nominal, problem.artefact.contact_planes, touches, options.formulation).matrix, shown);
  result.singular_values.assign(sigma.begin(), sigma.end());
  result = solve_and_hold(problem, options, sorted.fitted, result);
  if (!options.prior) name_weak(result);
  if (result.scale && !result.scale->warning.empty()) result.warnings.push_back(result.scale->warning);
  if (!problem.columns && result.identifiable.columns.size() < static_cast<std::size_t>(shown)) {
    result.singular_values.resize(result.identifiable.columns.size());
    result.rank_explanation = explain_rank(problem, sorted.fitted, result.identifiable, result.attainable);
  }
  result.distances = face_distances(problem, result);
  return result;
}

}  // namespace calib
