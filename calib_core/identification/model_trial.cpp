#include "calib_core/identification/model_trial.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "calib_core/estimation/gear_choice.hpp"
#include "calib_core/identification/model_selection.hpp"

namespace calib {
namespace {

/// What is tried, in words.
struct Trial {
  const char* what;
  const char* why_held;  // and what to do, for joints of which the touches do not tell it
};

constexpr Trial kHarmonicsTrial{
    "first harmonics of the joints",
    "these touches turn them too little to tell a harmonic (/gears/std_harmonic_rad in the arm's file) from "
    "the joint's offset, so that it stays in the uncertainty; spread the touches over 45 degrees and more of "
    "each joint, or give /identification/harmonics \"off\" in the recipe"};
constexpr Trial kRippleTrial{
    "ripples of the gears",
    "these touches turn them through less than a period of /gears/ripple_periods_per_turn in the arm's file, "
    "or by whole periods, where a ripple looks like the joint's offset or harmonic, so that it stays in the "
    "uncertainty; spread the touches over more of each joint, or give null for its period"};

void add_words(std::string& text, const std::string& words) { text += (text.empty() ? "" : "; ") + words; }

void not_tried(const Trial& trial, const std::string& why, IdentificationResult& result) {
  if (!why.empty()) add_words(result.model_reason, std::string(trial.what) + " not tried: " + why);
}

/// The same touches with these columns more, and what they ask for.
IdentificationResult taken_of(const Trial& trial, const GearColumns& more,
                              const IdentificationProblem& problem, const IdentificationOptions& options,
                              IdentificationResult smaller, const SolveAgain& solve_again) {
  std::string reason = smaller.model_reason;
  std::vector<std::string> warnings = smaller.warnings;
  if (!more.positions.empty()) {
    IdentificationOptions with_more = settled_options(options, smaller);
    auto& positions = *with_more.nongeometric;
    positions.insert(positions.end(), more.positions.begin(), more.positions.end());
    std::ranges::sort(positions);
    IdentificationResult larger = solve_again(with_more, smaller);
    const ModelChoice choice = choose_model(trial.what, problem, smaller, larger);
    add_words(reason, choice.reason);
    if (choice.take_larger) smaller = std::move(larger);
  }
  if (!more.held.empty()) {
    add_words(reason, std::string(trial.what) + " not tried: " + more.held);
    warnings.push_back(std::string(trial.what) + " are not estimated for " + more.held + ": " +
                       trial.why_held);
  }
  smaller.model_reason = std::move(reason);
  smaller.warnings = std::move(warnings);
  return smaller;
}

}  // namespace

IdentificationResult select_model(const IdentificationProblem& problem, const IdentificationOptions& options,
                                  const std::vector<std::size_t>& fitted, IdentificationResult smaller,
                                  const SolveAgain& solve_again) {
  const auto no_ripple = against_ripple(problem, options, smaller);
  if (const auto no_harmonics = against_harmonics(problem, options, smaller)) {
    not_tried(kHarmonicsTrial, *no_harmonics, smaller);
  } else {
    smaller = taken_of(kHarmonicsTrial, shown_harmonics(problem, fitted), problem, options,
                       std::move(smaller), solve_again);
  }
  if (no_ripple) {
    not_tried(kRippleTrial, *no_ripple, smaller);
    return smaller;
  }
  return taken_of(kRippleTrial, shown_ripples(problem, fitted), problem, options, std::move(smaller),
                  solve_again);
}

}  // namespace calib
