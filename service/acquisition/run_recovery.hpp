#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/run_planning.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/store/run_store.hpp"

namespace cell {

/// Why a run that a daemon left open cannot be resumed in this cell, one sentence; nothing when it can.
/// `config_digest` is that of the cell's files now.
std::optional<std::string> why_not_resumable(const Cell& cell, const StoredRun& run,
                                             const std::optional<std::string>& config_digest);

/// Going on with a run: one that an earlier daemon left open, which is on hold until a person asks for it,
/// then with the same plan, the same touches and an aim that knows what it knew; and any run on hold, whose
/// link and open command come first.
class RunRecovery {
 public:
  /// All must outlive it. The digest of the cell's files is taken here: it is that of the daemon's start.
  RunRecovery(const Cell& cell, const TipRegions& regions, RunStore& store, PlanCache& plans,
              ControllerSession& session, TouchPreparation& preparation, RunPlanning& planning,
              TouchExecutor& touches, PublishedStatus& status, Clocks clocks);

  [[nodiscard]] const std::optional<std::string>& config_digest() const { return config_digest_; }

  /// Takes up the run that the daemon before this one left open; one that cannot be resumed is ended in the
  /// store. Nothing moves by it. What the store throws comes through.
  std::optional<ActiveRun> restore();
  /// All that a run on hold needs before a person confirms that it goes on: a link, what became of its last
  /// command, its plan. False when another state was entered.
  boost::asio::awaitable<bool> make_resumable(ActiveRun& active);

 private:
  void end_for_good(const StoredRun& run, const std::string& why);
  void take_up_open_command(std::int64_t run_id);
  boost::asio::awaitable<bool> plan_again(ActiveRun& active);
  bool resume(ActiveRun& active);

  const Cell& cell_;
  const TipRegions& regions_;
  RunStore& store_;
  PlanCache& plans_;
  ControllerSession& session_;
  TouchPreparation& preparation_;
  RunPlanning& planning_;
  TouchExecutor& touches_;
  PublishedStatus& status_;
  Clocks clocks_;
  std::optional<std::string> config_digest_;
};

}  // namespace cell
