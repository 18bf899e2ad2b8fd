#pragma once

#include <functional>

#include "calib_core/identification/identification_result.hpp"

namespace calib {

/// Solves the touches of a converged result once more with other options; `first` has found the outliers and
/// the columns.
using SolveAgain =
    std::function<IdentificationResult(const IdentificationOptions&, const IdentificationResult& first)>;

/// The result that is taken after the one without: first harmonics are tried, then ripple, each as
/// model_selection.hpp decides. What was tried and why it was taken or not stands in `model_reason`; joints
/// whose harmonic or ripple these touches cannot tell (gear_choice.hpp) are not tried, and a warning names
/// them. `fitted`: the touches of `smaller`.
IdentificationResult select_model(const IdentificationProblem& problem, const IdentificationOptions& options,
                                  const std::vector<std::size_t>& fitted, IdentificationResult smaller,
                                  const SolveAgain& solve_again);

}  // namespace calib
