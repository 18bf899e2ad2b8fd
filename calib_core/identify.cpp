#include "calib_core/identify.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "calib_core/assess.hpp"
#include "calib_core/column_choice.hpp"
#include "calib_core/face_distances.hpp"
#include "calib_core/input_check.hpp"
#include "calib_core/least_squares.hpp"
#include "calib_core/robust.hpp"
#include "calib_core/units.hpp"

namespace calib {
namespace {

/// Steps under this that no longer shrink have reached the rounding of the weakest direction.
constexpr double kStepNormRounding = 1e-8;

/// More robust rounds than this do not settle.
constexpr int kRobustRoundsMax = 20;

/// What an arm may well be off by, or its block: the wide prior of the robust start.
constexpr double kPlausibleMetres = 0.010;
constexpr double kPlausibleRadians = 0.020;
constexpr double kLargeNoiseMetres = 1e-4;  // of a touch, where none is declared

/// The chance of the robust start's random subsets: fixed, so that the same touches give the same result.
constexpr std::uint64_t kRobustSeed = 20111101;

std::string scientific(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

/// Iterates from an estimate to the minimum over the kept touches.
class Iterations {
 public:
  Iterations(const IdentificationProblem& problem, const IdentificationOptions& options, LeastSquares& fit,
             const std::vector<int>& identifiable)
      : problem_(problem), options_(options), fit_(fit) {
    for (std::size_t i = 0; i < fit.arm_columns().size(); ++i) {
      if (std::ranges::binary_search(identifiable, fit.arm_columns()[i])) {
        positions_.push_back(static_cast<Eigen::Index>(i));
      }
    }
    history_.reserve(static_cast<std::size_t>(std::max(0, options.iterations_max)));
  }

  [[nodiscard]] Estimate nominal() const {
    Estimate estimate{problem_.start, {}};
    estimate.artefact.setZero(static_cast<Eigen::Index>(problem_.artefact.parameters.size()));
    return estimate;
  }

  /// Converged, or why not in message(). Leaves the fit linearised and solved at the estimate.
  bool run(Estimate& estimate, bool with_conditions) {
    history_.clear();
    message_.clear();
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < options_.iterations_max; ++i) {
      fit_.linearise(estimate);
      if (!fit_.solve()) {
        solvable_ = std::isfinite(fit_.residual_rms_m());
        message_ = solvable_ ? "the touches and the priors leave a direction open at step " +
                                   std::to_string(i + 1) + history_text()
                             : "the iteration left the finite numbers at step " + std::to_string(i + 1) +
                                   history_text();
        return false;
      }
      const auto conditions = with_conditions ? fit_.conditions(positions_) : LeastSquares::Conditions{};
      const double step = fit_.arm_step_norm();
      history_.push_back(
          {conditions.condition_number, conditions.scaled_condition_number, fit_.residual_rms_m(), step});
      estimate = fit_.stepped(std::move(estimate));
      if (step < kStepNormConverged || (step < kStepNormRounding && step > 0.5 * before)) return true;
      before = step;
    }
    message_ = "no convergence in " + std::to_string(options_.iterations_max) + " iterations" +
               history_text() + "; look for touches on the wrong plane";
    return false;
  }

  [[nodiscard]] const std::vector<Iteration>& history() const { return history_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] bool solvable() const { return solvable_; }

 private:
  [[nodiscard]] std::string history_text() const {
    std::string text;
    for (const Iteration& iteration : history_) {
      text += (text.empty() ? " (residual rms " : ", ") +
              scientific(mm_from_metres(iteration.residual_rms_m)) + " mm step " +
              scientific(iteration.step_norm);
    }
    return text.empty() ? text : text + ")";
  }

  const IdentificationProblem& problem_;
  const IdentificationOptions& options_;
  LeastSquares& fit_;
  std::vector<Eigen::Index> positions_;  // of the identifiable among the estimated columns
  std::vector<Iteration> history_;
  std::string message_;
  bool solvable_ = true;
};

/// Which touches belong together. Ends with the kept ones set in the fit, and converged or not.
class RobustSearch {
 public:
  RobustSearch(const IdentificationProblem& problem, LeastSquares& fit, Iterations& iterations)
      : known_noise_(problem.touch_noise_m > 0.0), fit_(fit), iterations_(iterations) {}

  /// Whether the declared noise explains the residuals of the fit at hand.
  [[nodiscard]] bool nothing_suspect() {
    if (!known_noise_) return fit_.residuals_m().cwiseAbs().maxCoeff() < kScatterMinMetres;
    return studentized(fit_).maxCoeff() <=
           largest_expected(fit_.kept_count(), std::numeric_limits<double>::infinity());
  }

  void run(const std::vector<int>& identifiable) {
    Estimate estimate = iterations_.nominal();
    const std::vector<bool> core = start(identifiable, estimate);
    std::vector<bool> kept = core;
    // The half that agrees best scatters too little to judge the others by: it is kept until no more join it.
    bool growing = true;
    for (int round = 0; round < kRobustRoundsMax; ++round) {
      fit_.keep(kept);
      if (!iterations_.run(estimate, false)) return;
      const std::vector<bool> good = judged(estimate);
      std::vector<bool> next = good;
      for (std::size_t i = 0; growing && i < next.size(); ++i) next[i] = good[i] || core[i];
      if (growing && next == kept) {
        growing = false;
        next = good;
      }
      if (next == kept) return;
      kept = next;
    }
  }

 private:
  /// A high-breakdown start: least trimmed squares of the problem linearised at the nominal arm, then
  /// concentrated once more where that leads.
  std::vector<bool> start(const std::vector<int>& identifiable, Estimate& estimate) {
    std::vector<bool> all(fit_.touches().size(), true);
    fit_.keep(all);
    fit_.linearise(estimate);
    std::mt19937_64 chance(kRobustSeed);
    std::vector<Eigen::Index> positions;
    for (std::size_t i = 0; i < fit_.arm_columns().size(); ++i) {
      if (std::ranges::binary_search(identifiable, fit_.arm_columns()[i])) {
        positions.push_back(static_cast<Eigen::Index>(i));
      }
    }
    const double noise = known_noise_ ? 1.0 : kLargeNoiseMetres / fit_.noise_unit_m();
    Eigen::VectorXd precision(static_cast<Eigen::Index>(positions.size()));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const int column = fit_.arm_columns()[static_cast<std::size_t>(positions[i])];
      const double std = error_parameters()[static_cast<std::size_t>(column)].is_length() ? kPlausibleMetres
                                                                                          : kPlausibleRadians;
      precision[static_cast<Eigen::Index>(i)] = noise * noise / (std * std);
    }
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::MatrixXd rows = fit_.rows()(Eigen::all, positions);
      const auto trimmed = least_trimmed_squares(rows, fit_.weighted_targets(), precision, chance);
      if (!trimmed) return all;
      for (std::size_t i = 0; i < positions.size(); ++i) {
        estimate.arm[fit_.arm_columns()[static_cast<std::size_t>(positions[i])]] +=
            trimmed->solution[static_cast<Eigen::Index>(i)];
      }
      all = trimmed->core;
      fit_.linearise(estimate);
    }
    return all;
  }

  /// The touches whose residuals a good touch could have.
  std::vector<bool> judged(const Estimate& estimate) {
    const Eigen::VectorXd sizes = studentized(fit_);
    const auto estimated = estimated_noise_m(fit_, estimate);
    const double scatter = std::max(estimated.value_or(0.0), kScatterMinMetres) / fit_.noise_unit_m();
    const bool declared_holds = known_noise_ && scatter <= 1.0;
    const double unit = declared_holds ? 1.0 : scatter;
    const double degrees =
        declared_holds ? std::numeric_limits<double>::infinity() : std::max(1, fit_.degrees_of_freedom());
    const double limit = unit * largest_expected(static_cast<int>(sizes.size()), degrees);
    std::vector<bool> kept(static_cast<std::size_t>(sizes.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      kept[i] = sizes[static_cast<Eigen::Index>(i)] <= limit;
    }
    return kept;
  }

  bool known_noise_;
  LeastSquares& fit_;
  Iterations& iterations_;
};

/// What is estimated: the chosen columns, or with the prior all that are not excluded.
std::vector<int> estimated_columns(const IdentificationOptions& options, const IdentifiableSet& chosen) {
  std::vector<int> columns = chosen.columns;
  if (options.prior) {
    columns.clear();
    for (int i = 0; i < kErrorParameterCount; ++i) {
      if (std::ranges::find(options.identifiability.excluded, i) == options.identifiability.excluded.end()) {
        columns.push_back(i);
      }
    }
  }
  for (int i = 0; options.stiffness && i < kComplianceCount; ++i) {
    columns.push_back(kErrorParameterCount + i);
  }
  return columns;
}

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
  const Linearisation whole = linearise_whole(problem, options, fit, estimate);
  result.certainty = certainty(problem, options, fit, whole, estimate, result.lack_of_fit);
  result.scale = check_scale(problem, options, fit, whole, *result.certainty, estimate);
  if (!result.scale->warning.empty()) result.warnings.push_back(result.scale->warning);
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
      refuse(result, std::move(*refusal));
      return result;
    }
    if (!problem.columns && shown < result.attainable.count &&
        shown_at_all(problem, options, sorted.fitted) < result.attainable.count) {
      result.status = IdentificationStatus::kUnobservable;
      result.message = result.rank_explanation;
      return result;
    }
    name_weak(result);
  } else if (sorted.fitted.empty()) {
    result.message = "0 touches: there is nothing to identify from";
    return result;
  }

  std::vector<Touch> touches;
  for (const std::size_t index : sorted.fitted) touches.push_back(problem.touches[index]);
  const Eigen::VectorXd sigma = largest_singular_values(
      observe(problem.nominal, problem.artefact.contact_planes, touches, options.formulation).matrix, shown);
  result.singular_values.assign(sigma.begin(), sigma.end());
  solve(problem, options, sorted.fitted, result);
  result.distances = face_distances(problem, result);
  return result;
}

}  // namespace calib
