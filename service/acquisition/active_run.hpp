#pragma once

#include <optional>
#include <string>
#include <vector>

#include "service/acquisition/hold_time.hpp"
#include "service/acquisition/place_check.hpp"
#include "service/run/run.hpp"
#include "service/run/verdict.hpp"
#include "service/store/run_outcome.hpp"

namespace cell {

/// What an earlier daemon left of a run that it did not end.
struct Interruption {
  std::optional<std::string> plan_id;
  std::vector<PlanChange> plan_changes;
  /// Why it cannot be resumed with the files that this daemon was started with; empty when it can be. These
  /// files say nothing of its touches, which are in the store only: so many of so many.
  std::string why_not;
  int touches_done = 0;
  int touches_total = 0;
};

/// The run under way or the last one: what belongs to it and to no other. A value; whoever acts on a run is
/// handed it.
struct ActiveRun {
  Run run;
  std::string conditions;                    // as kept with it
  bool guided = false;                       // its touches are made by hand
  bool open = true;                          // begun in the store, not finished there
  bool finished = false;                     // complete, and stored as such
  std::size_t stored_changes = 0;            // of its plan
  WorkTime worked;                           // on its touches and the ways to them
  std::optional<Interruption> interruption;  // until somebody resumes it
  std::optional<PlaceCheck> place_check;     // once it is planned, where the block was located
  bool block_is_away = false;  // a run before it may have left the block at another place than the first

  /// The changes of its plan behind the stored ones.
  [[nodiscard]] std::vector<PlanChange> changes_to_store() const;
  /// It waits for a daemon with its files, or for a person who ends it.
  [[nodiscard]] bool is_of_other_files() const { return interruption && !interruption->why_not.empty(); }
};

/// The result document, as json text; nothing before there is a result.
std::optional<std::string> result_json(const ActiveRun& active, const TipRegions& regions);

/// The calibrated arm that goes with it, as a file; nothing before there is a result.
std::optional<std::string> arm_json(const ActiveRun& active, const Cell& cell);

/// How a run ended, with what is stored of it.
struct Conclusion {
  Verdict verdict = Verdict::kIncomplete;
  bool finished = false;  // as ActiveRun::finished
  std::optional<std::string> result_json;
  std::optional<std::string> arm_json;
};

/// What a run that ends by `outcome` is worth: complete with every touch made and a result, its verdict is
/// that of its result document; else it is incomplete. Without an outcome it goes on as it is: only its
/// documents are made.
Conclusion conclude(const ActiveRun& active, std::optional<RunOutcome> outcome, const TipRegions& regions);

}  // namespace cell
