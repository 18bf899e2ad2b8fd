#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calib_core/planning/candidate_pool.hpp"
#include "calib_core/planning/touch_planning.hpp"

namespace calib {

/// What a choice of touches would tell, on the arm that aims and with everything as it is written down: the
/// figures that `identify` would give of exactly these touches.
struct ExpectedFigures {
  Certainty certainty;
  double condition_number = 0.0;  // of the identifiable columns, metres and radians
};

/// Which of the candidates to touch; indices.
struct TouchChoice {
  std::vector<std::size_t> fit;       // in no order
  std::vector<std::size_t> held_out;  // apart from the fitted ones and from each other, faces in turn
  /// Predicted over the region of the criterion, the workspace box for those that have none; metres. Nothing
  /// when no posture has the tip in that box and the criterion does not ask for it.
  std::optional<double> tip_rms_m;
};

/// The wanted accuracy cannot be had, or there is no posture that it could be had in; or the planes do not
/// show what is to be identified, however often they are touched.
struct ChoiceFailure {
  enum class Kind { kAccuracy, kPlanes };
  Kind kind = Kind::kAccuracy;
  std::optional<double> best_tip_rms_m;  // with all touches that are allowed
  std::string reason;                    // what they leave and where most of it comes from
};

/// Chooses by problem.goal: greedily, then by exchange of single touches (Fedorov, Theory of Optimal
/// Experiments, 1972) until no exchange is worth it. The tip error is predicted from the touch noise and
/// everything uncertain in the artefact. With goal.tip_rms_max_m the fewest touches that reach it, else
/// goal.fit_count. A face gets from fit_min to fit_max of them. `progress` is told the share that is done.
/// Fewer candidates of a face than fit_min and held_out_count together, or too few of all faces for fit_count
/// within fit_max: std::logic_error.
std::variant<TouchChoice, ChoiceFailure> choose_touches(const PlanningProblem& problem,
                                                        std::span<const TouchCandidate> candidates,
                                                        const std::function<void(double)>& progress = {});

/// What the touches with these postures (faces and joints; all are fitted) would tell. They must show all
/// that `knowledge` can identify; std::invalid_argument if they do not.
ExpectedFigures expected_figures(const PlanningProblem& problem, std::span<const Touch> touches);

}  // namespace calib
