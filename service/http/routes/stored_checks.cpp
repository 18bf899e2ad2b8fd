#include "service/http/routes/internal/stored_checks.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <tuple>

#include "config/utc_text.hpp"
#include "service/acquisition/past_calibration.hpp"
#include "service/documents/document_error.hpp"
#include "service/documents/model_document.hpp"
#include "service/run/expiring_certificates.hpp"
#include "service/run/verification.hpp"
#include "service/store/model_store.hpp"

namespace cell {
namespace {

/// One without a verdict where there is none that can be read.
CheckDocument result_of(const RunStore& store, std::int64_t check) try {
  const auto stored = store.result_json(check);
  return stored ? read_check(*stored) : CheckDocument();
} catch (const DocumentError&) {
  return {};
}

/// Nothing without a limit: a base that does not vary has none.
std::optional<double> share_of_limit(std::optional<double> value, std::optional<double> centre,
                                     std::optional<double> limit) {
  if (!value || !centre || !limit || *limit <= 0.0) return std::nullopt;
  return std::abs(*value - *centre) / *limit;
}

void find_limit_ratios(const ChecksDocument& document, CellFigures& figures) {
  for (const ChecksDocument::Chart& chart : document.charts) {
    if (chart.points.empty()) continue;
    const ChecksDocument::Point& newest = chart.points.back();
    // Nothing is less than any figure.
    auto ratio = std::max(share_of_limit(newest.value, chart.centre, newest.shewhart_limit),
                          share_of_limit(newest.weighted_mean, chart.centre, newest.ewma_limit));
    // A residual that is smaller than before is beyond no limit.
    if (ratio && !newest.beyond_shewhart && !newest.beyond_ewma) ratio = std::min(*ratio, 1.0);
    if (ratio) figures.limit_ratios[chart.quantity] = *ratio;
  }
}

void find_newest_verdict(const std::vector<EndedCheck>& checks, CellFigures& figures) {
  const EndedCheck* newest = newest_judged(checks);
  if (!newest) return;
  figures.is_unchanged = newest->result.verdict.accepted;
  for (const CheckDocument::Joint& joint : newest->result.joints) {
    if (joint.offset_mrad) figures.joint_offsets_rad[joint.joint] = *joint.offset_mrad * 1e-3;
  }
  if (newest->result.growth_ppm) figures.arm_growth = *newest->result.growth_ppm * 1e-6;
}

void find_checks(const RunStore& store, const Cell& cell, std::int64_t of_run,
                 std::chrono::system_clock::time_point now, CellFigures& figures) {
  const auto calibration = store.run(of_run);
  if (!calibration) return;
  const std::vector<EndedCheck> checks = checks_of(store, of_run);
  const ChecksDocument document = checks_view(*calibration, checks, cell.arm.model, cell.check_every, now);
  if (document.due_at) figures.check_due_at = time_from_utc(*document.due_at);
  for (const ChecksDocument::Check& check : document.checks) {
    if (check.reference || check.accepted) figures.checked_at = time_from_utc(check.ended_at);
  }
  find_newest_verdict(checks, figures);
  find_limit_ratios(document, figures);
}

void find_proof(const RunStore& store, std::int64_t of_run, CellFigures& figures) {
  for (const StoredRun& proof : store.complete_runs_of(of_run, RunKind::kProof)) {
    if (proof.verdict == Verdict::kAccepted || proof.verdict == Verdict::kRejected)
      figures.is_proved = proof.verdict == Verdict::kAccepted;
  }
}

void find_model(const RunStore& store, const Cell& cell, CellFigures& figures) {
  const ModelStore models(store.database());
  const auto standing = standing_approvals(models.history());
  if (standing.empty()) return;
  figures.model_approved_at = time_from_utc(standing.back().at);
  const ModelDocument model = read_model(models.document(standing.back().id).value());
  if (why_other_arm(model, cell)) {
    figures.is_model_of_this_arm = false;
  } else if (model.arm_serial && cell.arm_serial) {
    figures.is_model_of_this_arm = true;
  }
}

}  // namespace

std::vector<EndedCheck> checks_of(const RunStore& store, std::int64_t calibration) {
  std::vector<EndedCheck> checks;
  for (const StoredRun& check : store.complete_runs_of(calibration, RunKind::kCheck))
    checks.push_back(
        {check, result_of(store, check.id),
         may_be_reference(check) ? verifying_touches(store.touches(check.id)) : std::vector<calib::Touch>()});
  return checks;
}

std::vector<EndedCheck> checks_until(const RunStore& store, std::int64_t calibration,
                                     const StoredRun& check) {
  const auto when = [](const StoredRun& run) { return std::tie(run.ended_at, run.id); };
  std::vector<EndedCheck> checks = checks_of(store, calibration);
  if (check.ended_at)
    std::erase_if(checks, [&](const EndedCheck& one) { return when(one.run) > when(check); });
  return checks;
}

FoundFigures cell_figures(const RunStore& store, const Cell& cell,
                          std::chrono::system_clock::time_point now) {
  FoundFigures found;
  for (const CertificateEnd& end : certificate_ends(cell))
    found.figures.certificate_ends[end.artefact] = end.ends_at;
  std::optional<std::int64_t> of_run;
  const std::vector<std::function<void()>> parts{
      [&] { find_model(store, cell, found.figures); },
      [&] { of_run = calibration_of_cell(store, RunKind::kCheck); },
      [&] {
        if (of_run) find_proof(store, *of_run, found.figures);
      },
      [&] {
        if (of_run) find_checks(store, cell, *of_run, now, found.figures);
      }};
  for (const auto& find : parts) {
    try {
      find();
    } catch (const std::exception& error) {
      found.trouble = error.what();
    }
  }
  return found;
}

}  // namespace cell
