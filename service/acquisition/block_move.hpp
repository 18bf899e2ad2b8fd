#pragma once

#include <boost/asio/awaitable.hpp>
#include <vector>

#include "config/cell.hpp"
#include "service/acquisition/active_run.hpp"
#include "service/acquisition/parking.hpp"
#include "service/acquisition/published_status.hpp"
#include "service/acquisition/store_queue.hpp"
#include "service/acquisition/wake.hpp"

namespace cell {

/// What a run has stored last of where the block is; nothing where it says nothing.
std::optional<PlanChange> last_block_change(const std::vector<PlanChange>& changes);

/// Whether somebody may have taken the block away from its first place, by what a run has stored of it; the
/// last word counts. Nothing where it says nothing.
std::optional<bool> is_block_away(const std::vector<PlanChange>& changes);

/// Has a person bring the block from one place of a run's recipe to the next. It is stored that the block may
/// be on its way before anybody is asked, and that it stands at its new place before anything moves there:
/// after a restart no path is planned around a block that is elsewhere.
class BlockMove {
 public:
  /// All must outlive it.
  BlockMove(const Cell& cell, Parking& parking, StoreQueue& store, PublishedStatus& status, Wake& wake);

  /// No touch of the plan is left where the block stands, or it is on its way: parks the arm and holds the
  /// run with FaultCode::kBlockToMove. True when the run is held for it.
  boost::asio::awaitable<bool> ask(ActiveRun& active);
  /// A person's resume: the block stands where it was asked for. False when that could not be stored.
  boost::asio::awaitable<bool> take_word(ActiveRun& active);

 private:
  boost::asio::awaitable<bool> store(ActiveRun& active, PlanChange change, Event on_failure);

  const Cell& cell_;
  Parking& parking_;
  StoreQueue& store_;
  PublishedStatus& status_;
  Wake& wake_;
};

}  // namespace cell
