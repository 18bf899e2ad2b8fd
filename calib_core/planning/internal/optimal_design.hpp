#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/geometry/touch.hpp"
#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/planning_problem.hpp"
#include "calib_core/uncertainty/uncertainty_budget.hpp"

namespace calib {

/// Expected result of identify() for a choice of touches, for the nominal arm and artefact.
struct ExpectedFigures {
  UncertaintyBudget uncertainty;
  double condition_number = 0.0;  // of the identifiable columns, metres and radians
};

/// The chosen candidates; indices.
struct TouchChoice {
  std::vector<std::size_t> fit;  // in no order
  std::vector<std::size_t>
      held_out;  // at a distance from the fitted ones and from each other, faces alternating
  /// Predicted over the region of the criterion (the workspace box for criteria without a region), metres.
  /// Nothing when no posture has the tip in that box and the criterion does not need it.
  std::optional<double> tip_rms_m;
};

/// The wanted accuracy is not attainable, or the region has no posture, or touches on these faces cannot
/// determine the parameters.
struct ChoiceFailure {
  enum class Kind { kAccuracy, kUnidentifiable };
  Kind kind = Kind::kAccuracy;
  std::optional<double> best_tip_rms_m;  // with all allowed touches
  std::string reason;                    // the remaining error and its main source
};

/// Chooses touches by problem.goal: greedily, then by FedorovExchange. The tip error is predicted from the
/// touch noise and all uncertainties of the artefact. With goal.tip_rms_max_m the fewest touches that reach
/// it, else goal.fit_count. Each face gets from fit_min to fit_max. `progress` receives the completed share.
/// Throws std::logic_error when a face has fewer candidates than fit_min + held_out_count, or all faces
/// together too few for fit_count within fit_max.
std::variant<TouchChoice, ChoiceFailure> choose_touches(const PlanningProblem& problem,
                                                        std::span<const TouchCandidate> candidates,
                                                        const std::function<void(double)>& progress = {});

/// The expected figures of these touches (faces and joints; all are fitted). Throws std::invalid_argument
/// when they do not determine all that `knowledge` can identify.
ExpectedFigures expected_figures(const PlanningProblem& problem, std::span<const Touch> touches);

}  // namespace calib
