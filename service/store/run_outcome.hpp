#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace cell {

/// How far a run came.
enum class RunOutcome {
  kRunning,
  kComplete,
  kStopped,
  kAborted,
  kInterrupted,  // the daemon went away during it, and it was not resumed
};
inline constexpr std::array kRunOutcomes{RunOutcome::kRunning, RunOutcome::kComplete, RunOutcome::kStopped,
                                         RunOutcome::kAborted, RunOutcome::kInterrupted};
std::string_view run_outcome_name(RunOutcome outcome);  // "complete"
/// Nothing for a text that names no outcome.
std::optional<RunOutcome> run_outcome_named(std::string_view name);

/// What a run is worth. Apart from the outcome: a bad arm is a complete run that was rejected.
enum class Verdict { kNone, kAccepted, kRejected, kIncomplete };
inline constexpr std::array kVerdicts{Verdict::kNone, Verdict::kAccepted, Verdict::kRejected,
                                      Verdict::kIncomplete};
std::string_view verdict_name(Verdict verdict);  // "accepted"
std::optional<Verdict> verdict_named(std::string_view name);

}  // namespace cell
