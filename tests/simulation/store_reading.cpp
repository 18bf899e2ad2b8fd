#include "tests/simulation/store_reading.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "service/acquisition/active_run.hpp"
#include "service/run/block_temperature.hpp"
#include "service/run/run_recipe.hpp"

namespace simulation {
namespace {

/// The result of the stored touches alone, and why it is not accepted.
void add_undisturbed_result(const cell::TipRegions& regions, RunRecord& record) {
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
  record.undisturbed_json =
      cell::conclude(again, is_whole ? cell::RunOutcome::kComplete : cell::RunOutcome::kAborted, regions)
          .result_json;
  if (record.undisturbed_json)
    record.reasons = nlohmann::json::parse(*record.undisturbed_json).at("verdict").at("reasons");
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
                     .undisturbed_json = std::nullopt,
                     .reasons = {},
                     .refused = cell::refused_results(store, run.id)};
    if (regions != nullptr && run.outcome == cell::RunOutcome::kComplete)
      add_undisturbed_result(*regions, record);
    records.push_back(std::move(record));
  }
  return records;
}

}  // namespace simulation
