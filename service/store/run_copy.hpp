#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "service/store/refused_result.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// A run that ended with all that is stored of it, by value: what travels to the store of another daemon.
/// Not in it are what only its own daemon needs (the last command, the key of the request that began it,
/// resumptions) and the faults, which are in the log of its cell.
struct RunCopy {
  StoredRun run;                            // its id and of_run are those of the store that it is from
  std::vector<StoredTouch> touches;         // by number
  std::vector<SupersededTouch> superseded;  // oldest first, as the next two
  std::vector<ReferenceTouch> references;
  std::vector<PlanChange> plan_changes;
  std::vector<RefusedResult> refused;
  std::optional<std::string> plan_json;
  std::optional<std::string> result_json;
  std::optional<std::string> arm_json;
};

/// "put_off", "drop_fitted", "skip".
std::string_view plan_change_word(PlanChange::Kind kind);
/// Nothing for a text that names no kind of change.
std::optional<PlanChange::Kind> plan_change_with(std::string_view word);

/// Throws as what RunStore reads.
RunCopy copy_of_run(const RunStore& store, const StoredRun& run);

/// The store of a cell's daemon, when it takes runs of another daemon. What a call writes is durable on
/// return. Throws what the database throws; then nothing is written.
class RunImports {
 public:
  explicit RunImports(SharedDatabase database) : database_(std::move(database)) {}

  /// The run that is here already: the one of this origin that began at this time; nothing when there is
  /// none. `own_cell`: the name of this daemon's cell, whose runs need no import.
  [[nodiscard]] std::optional<std::int64_t> find(const RunOrigin& origin, const std::string& started_at,
                                                 const std::string& own_cell) const;
  /// The calibration of that cell with this id, as it is here; nothing when it is not.
  [[nodiscard]] std::optional<std::int64_t> imported_run(const std::string& cell, std::int64_t run_id) const;

  /// Stores the run as a new one, which nobody hears of as a run of this cell. `of_run`: the run here that it
  /// is of. Returns its id. The touches must have different numbers, and so must the reference touches.
  std::int64_t add(const RunCopy& copy, const RunOrigin& origin, std::optional<std::int64_t> of_run);

 private:
  SharedDatabase database_;
};

}  // namespace cell
