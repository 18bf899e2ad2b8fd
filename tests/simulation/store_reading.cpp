#include "tests/simulation/store_reading.hpp"

#include <algorithm>

#include "service/acquisition/active_run.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/run_recipe.hpp"

namespace simulation {
namespace {

std::optional<std::string> undisturbed_result(const RunRecord& record, const cell::TipRegions& regions) {
  const cell::StoredRun& stored = record.run;
  cell::ActiveRun again{
      .run = cell::Run(stored.id, regions, cell::recipe_of(stored, regions.cell()), stored.started_at,
                       cell::temperature_given_to(stored, regions.cell())),
      .conditions = stored.conditions_json.value_or(""),
      .interruption = std::nullopt,
      .place_check = std::nullopt};
  again.run.restore(record.touches, stored.touches_total);
  again.run.identify();
  const bool is_whole = static_cast<int>(record.touches.size()) == stored.touches_total;
  cell::conclude(again, is_whole ? cell::RunOutcome::kComplete : cell::RunOutcome::kAborted, regions);
  return cell::result_json(again, regions);
}

}  // namespace

std::vector<RunRecord> read_runs(const cell::RunStore& store, const cell::TipRegions* regions) {
  std::vector<cell::StoredRun> runs = store.runs(1000);
  std::ranges::reverse(runs);
  std::vector<RunRecord> records;
  for (cell::StoredRun& run : runs) {
    RunRecord record{.run = run,
                     .touches = store.touches(run.id),
                     .superseded = store.superseded_touches(run.id),
                     .result_json = store.result_json(run.id),
                     .undisturbed_json = std::nullopt};
    if (regions != nullptr && run.outcome == cell::RunOutcome::kComplete)
      record.undisturbed_json = undisturbed_result(record, *regions);
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace simulation
