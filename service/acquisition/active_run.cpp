#include "service/acquisition/active_run.hpp"

#include "service/documents/result_view.hpp"
#include "service/documents/verification_view.hpp"
#include "service/run/calibrated_arm.hpp"
#include "service/run/verdict.hpp"

namespace cell {
namespace {

bool has_result(const ActiveRun& active) {
  return active.run.latest().status == calib::IdentificationStatus::kConverged;
}

ResultDocument document_of(const ActiveRun& active, bool complete, const TipRegions& regions) {
  const Run& run = active.run;
  return result_of(regions, run.recipe(), run.problem(), run.latest(),
                   {.complete = complete, .warnings = {}, .conditions = active.conditions});
}

VerificationResult verified(const ActiveRun& active, bool complete, const TipRegions& regions) {
  return verification_result(regions, active.run, {.complete = complete, .conditions = active.conditions});
}

Conclusion conclude_verification(const ActiveRun& active, std::optional<RunOutcome> outcome,
                                 const TipRegions& regions) {
  Conclusion concluded{.finished = active.finished};
  if (outcome) concluded.finished = outcome == RunOutcome::kComplete && active.run.skipped_count() == 0;
  if (active.run.touches_done() == 0) return concluded;
  VerificationResult result = verified(active, concluded.finished, regions);
  if (outcome && concluded.finished) concluded.verdict = result.verdict;
  concluded.result_json = std::move(result.document);
  return concluded;
}

}  // namespace

std::vector<PlanChange> ActiveRun::changes_to_store() const {
  const std::vector<PlanChange>& changes = run.plan_changes();
  return {changes.begin() + static_cast<std::ptrdiff_t>(stored_changes), changes.end()};
}

std::optional<std::string> result_json(const ActiveRun& active, const TipRegions& regions) {
  if (active.run.verification()) {
    if (active.run.touches_done() == 0) return std::nullopt;
    return verified(active, active.finished, regions).document;
  }
  if (!has_result(active)) return std::nullopt;
  return document_text(document_of(active, active.finished, regions));
}

std::optional<std::string> arm_json(const ActiveRun& active, const Cell& cell) {
  if (!has_result(active)) return std::nullopt;
  return calibrated_arm_document(cell, active.run.latest());
}

Conclusion conclude(const ActiveRun& active, std::optional<RunOutcome> outcome, const TipRegions& regions) {
  if (active.run.verification()) return conclude_verification(active, outcome, regions);
  Conclusion concluded{.finished = active.finished};
  if (outcome)
    concluded.finished =
        outcome == RunOutcome::kComplete && active.run.skipped_count() == 0 && has_result(active);
  if (!has_result(active)) return concluded;
  const ResultDocument document = document_of(active, concluded.finished, regions);
  if (outcome && concluded.finished)
    concluded.verdict = document.verdict.accepted ? Verdict::kAccepted : Verdict::kRejected;
  concluded.result_json = document_text(document);
  concluded.arm_json = arm_json(active, regions.cell());
  return concluded;
}

}  // namespace cell
