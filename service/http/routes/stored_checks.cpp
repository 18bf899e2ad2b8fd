#include "service/http/routes/internal/stored_checks.hpp"

#include "service/documents/document_error.hpp"

namespace cell {
namespace {

/// One without a verdict where there is none that can be read.
CheckDocument result_of(const RunStore& store, std::int64_t check) try {
  const auto stored = store.result_json(check);
  return stored ? read_check(*stored) : CheckDocument();
} catch (const DocumentError&) {
  return {};
}

}  // namespace

std::vector<EndedCheck> checks_of(const RunStore& store, std::int64_t calibration) {
  std::vector<EndedCheck> checks;
  for (const StoredRun& check : store.complete_runs_of(calibration, RunKind::kCheck))
    checks.push_back({check, result_of(store, check.id)});
  return checks;
}

}  // namespace cell
