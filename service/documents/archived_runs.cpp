#include "service/documents/archived_runs.hpp"

#include <spdlog/fmt/fmt.h>

#include <cstdint>
#include <map>
#include <set>

#include "service/documents/internal/document_fields.hpp"
#include "service/store/outbox.hpp"

namespace cell {
namespace {

/// What the facts of a run tell of it, each some of these (surfaces.md, section 9).
struct ToldRun {
  std::optional<std::string> kind;
  std::optional<std::int64_t> of_run;
  std::optional<std::string> recipe;
  std::optional<std::string> touch_mode;
  std::optional<std::string> outcome;
  std::optional<Verdict> verdict;
  std::optional<std::string> fault_code;
  std::optional<std::string> fault_message;
  std::optional<int> touches_done;
  std::optional<int> touches_total;
  std::optional<int> touches;

  template <class Self, class Fields>
  static void visit(Self& self, Fields& fields) {
    fields("kind", self.kind);
    fields("of_run", self.of_run);
    fields("recipe", self.recipe);
    fields("touching", self.touch_mode);
    fields("outcome", self.outcome);
    fields("verdict", self.verdict);
    fields("fault_code", self.fault_code);
    fields("fault_message", self.fault_message);
    fields("touches_done", self.touches_done);
    fields("touches_total", self.touches_total);
    fields("touches", self.touches);
  }
};

constexpr std::string_view kWithdrawn = "withdrawn";

RunOutcome outcome_of(const std::string& word) {
  if (const auto outcome = run_outcome_named(word)) return *outcome;
  throw DocumentError("/outcome", fmt::format("'{}' is not known; a newer touchcal may know it", word));
}

void end_run(const ArchivedFact& fact, const ToldRun& told, RunSummary& run) {
  if (told.outcome) run.outcome = outcome_of(*told.outcome);
  run.ended_at = fact.at;
  run.verdict = told.verdict.value_or(Verdict::kNone);
  run.fault_code = told.fault_code;
  run.fault_message = told.fault_message;
  run.touches_done = told.touches_done.value_or(0);
  if (told.touches_total.value_or(0) > 0)
    run.touches_total = told.touches_total;  // else it was never planned
}

void add(const ArchivedFact& fact, const ToldRun& told, RunSummary& run) {
  if (told.kind) run.kind = *told.kind;
  if (told.recipe) run.recipe = *told.recipe;
  if (told.of_run) run.of_run = std::to_string(*told.of_run);
  if (told.touch_mode) run.touch_mode = told.touch_mode;
  if (told.touches) run.touches_done = *told.touches;
  if (fact.kind == fact_kind_name(FactKind::kRunStarted)) run.started_at = fact.at;
  if (fact.kind == fact_kind_name(FactKind::kRunEnded)) end_run(fact, told, run);
}

/// Others say what became of a model, or of something that happened meanwhile.
bool is_of_a_run(const ArchivedFact& fact) {
  static const std::set<std::string_view> kKinds{
      fact_kind_name(FactKind::kRunStarted), fact_kind_name(FactKind::kTouchSetClosed),
      fact_kind_name(FactKind::kRunEnded), fact_kind_name(FactKind::kProof),
      fact_kind_name(FactKind::kCheck)};
  return fact.run_id && kKinds.contains(fact.kind);
}

}  // namespace

RunsDocument archived_runs(std::span<const ArchivedFact> facts) {
  std::map<std::int64_t, RunSummary, std::greater<>> runs;
  std::map<std::int64_t, std::string, std::greater<>> damaged;
  for (const ArchivedFact& fact : facts) {
    if (!is_of_a_run(fact)) continue;
    const std::int64_t id = std::stoll(*fact.run_id);
    try {
      const auto told = document_from<ToldRun>(fact.body.text, Absent::kKeepsDefault);
      if (told.outcome == kWithdrawn) {
        runs.erase(id);  // as the cell forgot it
        continue;
      }
      RunSummary& run =
          runs.try_emplace(id, RunSummary{.id = *fact.run_id, .kind = "calibration"}).first->second;
      add(fact, told, run);
    } catch (const DocumentError& error) {
      damaged.try_emplace(id, fmt::format("event {} of the archive: {}", fact.seq, error.what()));
    }
  }
  RunsDocument document;
  for (auto& [id, run] : runs)
    if (!damaged.contains(id)) document.runs.push_back(std::move(run));
  for (const auto& [id, detail] : damaged) document.damaged.push_back({std::to_string(id), detail});
  return document;
}

}  // namespace cell
