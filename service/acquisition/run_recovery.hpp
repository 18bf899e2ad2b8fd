#pragma once

#include <boost/asio/awaitable.hpp>
#include <optional>
#include <string>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/run_planning.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/touch_executor.hpp"

namespace cell {

/// Why a run that a daemon left open cannot be resumed in this cell, in one sentence; empty when it can be.
/// `config_digest` is the digest of the cell's files now.
std::optional<std::string> why_not_resumable(const Cell& cell, const StoredRun& run,
                                             const std::optional<std::string>& config_digest);

/// The same for a person, with what to do.
std::string kept_words(const std::string& why);

/// Resumes runs. A run that an earlier daemon left open stays on hold until a person resumes it, with the
/// same plan, touches and estimate. For any run on hold, the link and the open command are settled first.
class RunRecovery {
 public:
  /// All must outlive it. Takes the digest of the cell's files, at the daemon's start.
  RunRecovery(const Cell& cell, const std::optional<BlockPose>& place, const TipRegions& regions,
              StoreQueue& store, PlanCache& plans, ControllerSession& session, TouchPreparation& preparation,
              RunPlanning& planning, TouchExecutor& touches, PublishedStatus& status, Clocks clocks);

  [[nodiscard]] const std::optional<std::string>& config_digest() const { return config_digest_; }

  /// Takes up the run that the previous daemon left open. One of other files stays on hold without its
  /// touches (ActiveRun::is_of_other_files): a start is nobody's decision to end it. One whose rows are
  /// damaged, or whose touches cannot be those of a run of this cell, ends in the store. Moves nothing.
  /// Passes on what the store throws. Before the store's thread begins.
  std::optional<ActiveRun> restore();
  /// Prepares a run on hold for a person's confirmation: the link, the outcome of its last command, its plan.
  /// False when another state was entered.
  boost::asio::awaitable<bool> make_resumable(ActiveRun& active);

 private:
  std::optional<StoredRun> open_run();
  std::optional<ActiveRun> take_up(const StoredRun& stored);
  std::variant<std::shared_ptr<const Verification>, std::string> verification_again(const StoredRun& stored);
  ActiveRun keep_on_hold(const StoredRun& stored, const std::string& why);
  void end_for_good(const StoredRun& run, const std::string& why);
  void take_up_open_command(std::int64_t run_id);
  boost::asio::awaitable<bool> plan_again(ActiveRun& active);
  boost::asio::awaitable<bool> resume(ActiveRun& active);

  const Cell& cell_;
  const std::optional<BlockPose>& place_;  // where the block was located, if it was
  const TipRegions& regions_;
  StoreQueue& store_;
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
