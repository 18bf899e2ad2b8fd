#include "service/store/run_outcome.hpp"

namespace cell {

std::string_view run_outcome_name(RunOutcome outcome) {
  switch (outcome) {
    case RunOutcome::kRunning:
      return "running";
    case RunOutcome::kComplete:
      return "complete";
    case RunOutcome::kStopped:
      return "stopped";
    case RunOutcome::kAborted:
      return "aborted";
    case RunOutcome::kInterrupted:
      return "interrupted";
  }
  return "";
}

std::optional<RunOutcome> run_outcome_named(std::string_view name) {
  for (const RunOutcome outcome : kRunOutcomes)
    if (run_outcome_name(outcome) == name) return outcome;
  return std::nullopt;
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kNone:
      return "none";
    case Verdict::kAccepted:
      return "accepted";
    case Verdict::kRejected:
      return "rejected";
    case Verdict::kIncomplete:
      return "incomplete";
  }
  return "";
}

std::optional<Verdict> verdict_named(std::string_view name) {
  for (const Verdict verdict : kVerdicts)
    if (verdict_name(verdict) == name) return verdict;
  return std::nullopt;
}

}  // namespace cell
