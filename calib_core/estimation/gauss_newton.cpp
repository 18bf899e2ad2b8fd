#include "calib_core/estimation/gauss_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "calib_core/geometry/units.hpp"

namespace calib {
namespace {

/// Smaller steps that no longer shrink are rounding errors of the weakest direction.
constexpr double kStepNormRounding = 1e-8;

std::string scientific(double value) {
  std::ostringstream text;
  text.precision(3);
  text << value;
  return text.str();
}

}  // namespace

GaussNewton::GaussNewton(const IdentificationProblem& problem, const IdentificationOptions& options,
                         LeastSquares& fit, const std::vector<int>& identifiable)
    : problem_(problem), options_(options), fit_(fit) {
  for (std::size_t i = 0; i < fit.arm_columns().size(); ++i) {
    if (std::ranges::binary_search(identifiable, fit.arm_columns()[i])) {
      positions_.push_back(static_cast<Eigen::Index>(i));
    }
  }
  history_.reserve(static_cast<std::size_t>(std::max(0, options.iterations_max)));
}

Estimate GaussNewton::start() const {
  Estimate estimate{problem_.start, {}};
  estimate.artefact.setZero(static_cast<Eigen::Index>(problem_.artefact.parameters.size()));
  return estimate;
}

bool GaussNewton::run(Estimate& estimate, bool with_conditions) {
  history_.clear();
  message_.clear();
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < options_.iterations_max; ++i) {
    fit_.linearise(estimate);
    if (!fit_.solve()) {
      solvable_ = std::isfinite(fit_.residual_rms_m());
      message_ = std::string(solvable_ ? "touches and standard deviations leave a direction undetermined "
                                         "(touch more, or give more "
                                         "standard deviations) at step "
                                       : "the iteration reached numbers that are not finite at step ") +
                 std::to_string(i + 1) + history_text();
      return false;
    }
    const auto conditions = with_conditions ? fit_.condition_numbers(positions_) : ConditionNumbers{};
    const double step = fit_.arm_step_norm();
    history_.push_back({conditions.as_is, conditions.unit_columns, fit_.residual_rms_m(), step});
    estimate = fit_.stepped(std::move(estimate));
    if (step < kStepNormConverged || (step < kStepNormRounding && step > 0.5 * before)) return true;
    before = step;
  }
  message_ = "no convergence in " + std::to_string(options_.iterations_max) + " iterations" + history_text() +
             "; look for touches on the wrong plane";
  return false;
}

std::string GaussNewton::history_text() const {
  std::string text;
  for (const Iteration& iteration : history_) {
    text += (text.empty() ? " (residual rms " : ", ") + scientific(mm_from_metres(iteration.residual_rms_m)) +
            " mm step " + scientific(iteration.step_norm);
  }
  return text.empty() ? text : text + ")";
}

}  // namespace calib
