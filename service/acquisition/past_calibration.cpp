#include "service/acquisition/past_calibration.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>

#include "service/documents/conditions_view.hpp"
#include "service/store/model_store.hpp"

namespace cell {

std::optional<std::int64_t> calibration_of_cell(const RunStore& store, RunKind kind) {
  if (kind != RunKind::kProof) {
    const auto standing = standing_approvals(ModelStore(store.database()).history());
    if (!standing.empty()) return standing.back().run_id;
  }
  const auto accepted = store.last_accepted();
  return accepted ? std::optional(accepted->id) : std::nullopt;
}

namespace {

std::optional<std::string> why_not_of(const StoredRun& run, const std::optional<std::string>& config_digest) {
  if (run.kind != RunKind::kCalibration)
    return fmt::format("run {} is a {}; name the run of a calibration", run.id, run_kind_name(run.kind));
  if (run.outcome != RunOutcome::kComplete || run.verdict != Verdict::kAccepted)
    return fmt::format("run {} is not a calibration that was accepted; calibrate, then once more", run.id);
  if (run.config_digest != config_digest)
    return fmt::format(
        "the cell's files have changed since run {}: start touchcald with the files that it had, or "
        "calibrate "
        "anew",
        run.id);
  return std::nullopt;
}

}  // namespace

std::variant<PastCalibration, VerificationRefusal> find_calibration(
    const RunStore& store, RunKind kind, std::optional<std::int64_t> of_run,
    const std::optional<std::string>& config_digest) {
  if (!of_run) of_run = calibration_of_cell(store, kind);
  if (!of_run)
    return VerificationRefusal{
        fmt::format("there is no accepted calibration that a {} could be of: touchcal run, then once more",
                    run_kind_name(kind))};
  auto run = store.run(*of_run);
  if (!run)
    return VerificationRefusal{
        .message = fmt::format("there is no run {}; touchcal runs lists them", *of_run),
        .is_unknown_run = true};
  if (auto why = why_not_of(*run, config_digest)) return VerificationRefusal{*std::move(why)};
  PastCalibration past{.run = *run,
                       .touches = store.touches(run->id),
                       .references = store.references(run->id),
                       .qualified = qualified_noise(run->conditions_json),
                       .cell_from_block = block_stood_at(run->conditions_json),
                       .checks = {}};
  if (kind == RunKind::kCheck)
    for (const StoredRun& check : store.complete_runs_of(run->id, RunKind::kCheck))
      if (may_be_reference(check)) past.checks.push_back({check, store.touches(check.id)});
  return past;
}

}  // namespace cell
