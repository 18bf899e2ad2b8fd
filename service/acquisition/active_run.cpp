#include "service/acquisition/active_run.hpp"

#include "service/documents/result_view.hpp"
#include "service/run/decision_rule.hpp"

namespace cell {

std::optional<std::string> result_json(const ActiveRun& active, const TipRegions& regions) {
  const Run& run = active.run;
  if (run.latest().status != calib::IdentificationStatus::kConverged) return std::nullopt;
  return result_document(regions, run.recipe(), run.problem(), run.latest(),
                         {.complete = active.finished, .warnings = {}, .conditions = active.conditions});
}

Verdict conclude(ActiveRun& active, RunOutcome outcome, const Cell& cell) {
  const Run& run = active.run;
  active.finished = outcome == RunOutcome::kComplete && run.skipped_count() == 0 &&
                    run.latest().status == calib::IdentificationStatus::kConverged;
  if (!active.finished) return Verdict::kIncomplete;
  const Judgement judgement =
      judge_by_rule(run.latest(), run.recipe().identification, cell, run.predicted_tip_rms_m(), true);
  return judgement.accepted ? Verdict::kAccepted : Verdict::kRejected;
}

}  // namespace cell
