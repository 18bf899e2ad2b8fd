#include "calib_core/identification/validate.hpp"

#include <algorithm>

#include "calib_core/identification/face_distances.hpp"
#include "calib_core/identification/model_selection.hpp"

namespace calib {
namespace {

bool is_rejected(const IdentificationResult& result, std::size_t touch) {
  return std::ranges::find(result.rejected, touch, &RejectedTouch::touch) != result.rejected.end();
}

std::vector<Touch> kept_touches(const IdentificationProblem& problem, const IdentificationResult& result,
                                TouchRole role) {
  std::vector<Touch> touches;
  for (std::size_t i = 0; i < problem.touches.size(); ++i) {
    if (problem.touches[i].role == role && !is_rejected(result, i)) touches.push_back(problem.touches[i]);
  }
  return touches;
}

/// The problem that starts from the calibrated arm with the columns that were chosen for it.
IdentificationProblem from_calibrated(IdentificationProblem problem, const IdentificationResult& result,
                                      std::vector<Touch> touches) {
  problem.touches = std::move(touches);
  for (Touch& touch : problem.touches) touch.role = TouchRole::kFit;
  problem.attainable = result.attainable;
  problem.columns = result.identifiable.columns;
  problem.start = result.errors;
  return problem;
}

Repetition repeat(const IdentificationProblem& problem, const IdentificationOptions& options) {
  const IdentificationResult again = identify(problem, options);
  Repetition repetition{.status = again.status,
                        .message = again.message,
                        .touch_count = again.fitted_touch_count,
                        .iteration_count = static_cast<int>(again.iterations.size())};
  if (!repetition.done()) return repetition;
  repetition.new_errors = again.errors - problem.start;
  repetition.std_new_errors =
      (again.uncertainty->identified + again.uncertainty->held).diagonal();  // variances here
  return repetition;
}

Repetition repeat_with_others(const IdentificationProblem& problem, const IdentificationOptions& options,
                              const IdentificationResult& result, std::vector<Touch> touches) {
  const auto count = static_cast<int>(touches.size());
  const int needed = result.attainable.count + kSpareTouchesMin;
  if (count < needed) {
    return {.message = "the repetition with another set needs at least " + std::to_string(needed) +
                       " touches, and there are " + std::to_string(count) +
                       "; hold out more touches or give another file",
            .touch_count = count};
  }
  Repetition repetition = repeat(from_calibrated(problem, result, std::move(touches)), options);
  if (repetition.done()) {
    repetition.std_new_errors =
        (repetition.std_new_errors + (result.uncertainty->identified + result.uncertainty->held).diagonal())
            .cwiseSqrt();
  }
  return repetition;
}

}  // namespace

Validation validate(const IdentificationProblem& problem, const IdentificationOptions& options,
                    std::span<const Touch> other_touches) {
  return validate(problem, options, identify(problem, options), other_touches);
}

Validation validate(const IdentificationProblem& problem, const IdentificationOptions& options,
                    IdentificationResult known, std::span<const Touch> other_touches) {
  Validation validation{.result = std::move(known)};
  IdentificationResult& result = validation.result;
  if (result.status != IdentificationStatus::kConverged) return validation;

  // Outliers and model are known; the held-out touches, which may have chosen it, are not among these.
  const IdentificationOptions all_kept = settled_options(options, result);
  validation.same_touches =
      repeat(from_calibrated(problem, result, kept_touches(problem, result, TouchRole::kFit)), all_kept);
  validation.same_touches.std_new_errors.setZero();

  const bool given = !other_touches.empty();
  validation.other_touches =
      repeat_with_others(problem, options, result,
                         given ? std::vector<Touch>(other_touches.begin(), other_touches.end())
                               : kept_touches(problem, result, TouchRole::kHeldOut));
  if (given) {
    IdentificationProblem with_others = problem;
    for (Touch touch : other_touches) {
      touch.role = TouchRole::kHeldOut;
      with_others.touches.push_back(touch);
    }
    result.distances = face_distances(with_others, result);
  }
  return validation;
}

}  // namespace calib
