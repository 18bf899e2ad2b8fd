#include "service/acquisition/active_run.hpp"

#include "service/documents/result_view.hpp"
#include "service/run/verdict.hpp"

namespace cell {

std::optional<std::string> result_json(const ActiveRun& active, const TipRegions& regions) {
  const Run& run = active.run;
  if (run.latest().status != calib::IdentificationStatus::kConverged) return std::nullopt;
  return result_document(regions, run.recipe(), run.problem(), run.latest(),
                         {.complete = active.finished, .warnings = {}, .conditions = active.conditions});
}

Verdict conclude(ActiveRun& active, RunOutcome outcome, const TipRegions& regions) {
  const Run& run = active.run;
  active.finished = outcome == RunOutcome::kComplete && run.skipped_count() == 0 &&
                    run.latest().status == calib::IdentificationStatus::kConverged;
  if (!active.finished) return Verdict::kIncomplete;
  const TipPrediction tip = predict_tip(regions, run.problem(), run.latest());
  const std::vector<Criterion> judged =
      criteria(run.latest(), run.recipe().identification, regions.cell(), judged_tip(tip));
  const Judgement judgement = judge(run.latest(), judged, regions.cell().acceptance, true);
  return judgement.accepted ? Verdict::kAccepted : Verdict::kRejected;
}

}  // namespace cell
