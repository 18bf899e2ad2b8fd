#pragma once

#include <boost/asio/awaitable.hpp>
#include <memory>
#include <optional>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/plan_cache.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/touch_preparation.hpp"
#include "service/acquisition/wake.hpp"
#include "service/run/block_pose.hpp"

namespace cell {

/// What the plan of this run is made with.
PlanGiven given_to(const Run& run);

/// Gives a run its plan at the start; run, store and touch preparation get the same one. Called by the cell's
/// loop and by the run recovery.
class RunPlanning {
 public:
  /// All must outlive it. `place`: where the block was located, if it was.
  RunPlanning(const Cell& cell, const std::optional<BlockPose>& place, StoreQueue& store, PlanCache& plans,
              TouchPreparation& preparation, PublishedStatus& status, Wake& wake);

  /// False when there is no plan, which raises a fault, or when another state was entered meanwhile. A plan
  /// that could not be stored holds the run, which has none then.
  boost::asio::awaitable<bool> plan(ActiveRun& active);
  /// Waits for what the plan cache has for this run. False when another state was entered meanwhile: a stop
  /// does not wait for the planner, and the planner gives up what nobody waits for.
  boost::asio::awaitable<bool> wait_for_outcome(const Run& run);
  /// Hands the plan to the run; there is no estimate of the arm yet.
  void begin_touches(ActiveRun& active);

 private:
  boost::asio::awaitable<bool> adopt(ActiveRun& active, std::shared_ptr<const Plan> plan);

  const Cell& cell_;
  const std::optional<BlockPose>& place_;
  StoreQueue& store_;
  PlanCache& plans_;
  TouchPreparation& preparation_;
  PublishedStatus& status_;
  Wake& wake_;
};

}  // namespace cell
