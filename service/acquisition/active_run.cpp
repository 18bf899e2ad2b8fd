#include "service/acquisition/active_run.hpp"

#include "service/documents/result_view.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/verdict.hpp"

namespace cell {

std::vector<PlanChange> ActiveRun::changes_to_store() const {
  const std::vector<PlanChange>& changes = run.plan_changes();
  return {changes.begin() + static_cast<std::ptrdiff_t>(stored_changes), changes.end()};
}

std::optional<std::string> result_json(const ActiveRun& active, const TipRegions& regions) {
  const Run& run = active.run;
  if (run.latest().status != calib::IdentificationStatus::kConverged) return std::nullopt;
  return result_document(regions, run.recipe(), run.problem(), run.latest(),
                         {.complete = active.finished, .warnings = {}, .conditions = active.conditions});
}

std::optional<std::string> arm_json(const ActiveRun& active, const Cell& cell) {
  const calib::IdentificationResult& latest = active.run.latest();
  if (latest.status != calib::IdentificationStatus::kConverged) return std::nullopt;
  return calibrated_arm_document(cell, latest);
}

Verdict conclude(ActiveRun& active, RunOutcome outcome, const TipRegions& regions) {
  const Run& run = active.run;
  active.finished = outcome == RunOutcome::kComplete && run.skipped_count() == 0 &&
                    run.latest().status == calib::IdentificationStatus::kConverged;
  if (!active.finished) return Verdict::kIncomplete;
  const TipPrediction tip = predict_tip(regions, run.problem(), run.latest());
  const std::vector<Criterion> judged =
      criteria(run.latest(), run.recipe(), regions.cell(), judged_tip(tip), true);
  const Judgement judgement = judge(judged, regions.cell().acceptance);
  return judgement.accepted ? Verdict::kAccepted : Verdict::kRejected;
}

}  // namespace cell
