// Each co_await stands alone in its statement, see cs8_controller.cpp.
#include "service/acquisition/block_move.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "calib_core/geometry/units.hpp"
#include "config/touched_places.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

bool is_of_block(const PlanChange& change) {
  return change.kind == PlanChange::Kind::kBlockToMove || change.kind == PlanChange::Kind::kBlockMoved;
}

std::string words_for(const Cell& cell, const Run& run, int place) {
  const Block& block = cell.block;
  if (place == 0) return R"(to "first", where it was located)";
  std::string words = fmt::format("to \"{}\"", place_name(block, run.recipe(), place));
  if (!is_found_by_touches(block, run.recipe(), place)) return words + ", into its dowels";
  return words + fmt::format(", within {:.0f} mm of where the block's file has it",
                             calib::mm_from_metres(found_within_m(block, run.recipe(), place)));
}

}  // namespace

std::optional<PlanChange> last_block_change(const std::vector<PlanChange>& changes) {
  const auto last = std::find_if(changes.rbegin(), changes.rend(), is_of_block);
  return last == changes.rend() ? std::nullopt : std::optional(*last);
}

std::optional<bool> is_block_away(const std::vector<PlanChange>& changes) {
  const auto last = last_block_change(changes);
  if (!last) return std::nullopt;
  return last->kind == PlanChange::Kind::kBlockToMove || last->place != 0;
}

BlockMove::BlockMove(const Cell& cell, Parking& parking, StoreQueue& store, PublishedStatus& status,
                     Wake& wake)
    : cell_(cell), parking_(parking), store_(store), status_(status), wake_(wake) {}

asio::awaitable<bool> BlockMove::ask(ActiveRun& active) {
  Run& run = active.run;
  if (!run.moving_to()) {
    const int place = run.place_of(run.next()->face);
    const State state = status_.state();
    const bool parked = co_await parking_.park(active);
    if (status_.state() != state) co_return false;
    if (!parked) {
      co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
      co_return false;
    }
    const bool stored = co_await store(active, {PlanChange::Kind::kBlockToMove, place}, Event::kHoldFault);
    if (!stored || status_.state() != state) co_return false;
  }
  status_.raise({FaultCode::kBlockToMove, words_for(cell_, run, *run.moving_to())}, Event::kHoldFault);
  co_return true;
}

asio::awaitable<bool> BlockMove::take_word(ActiveRun& active) {
  const int place = *active.run.moving_to();
  const bool stored = co_await store(active, {PlanChange::Kind::kBlockMoved, place}, Event::kNotReadyFault);
  if (stored)
    spdlog::info("run {}: a person says that the block stands {}", active.run.id(),
                 words_for(cell_, active.run, place));
  co_return stored;
}

asio::awaitable<bool> BlockMove::store(ActiveRun& active, PlanChange change, Event on_failure) {
  std::vector<PlanChange> changes = active.changes_to_store();
  changes.push_back(change);
  const auto write = [id = active.run.id(), changes](RunStore& store) { store.change_plan(id, changes); };
  const auto failure = co_await store_.write(write);
  if (failure) {
    status_.raise({FaultCode::kStoreFailed, *failure}, on_failure);
    co_return false;
  }
  active.run.change_plan(change);
  active.stored_changes = active.run.plan_changes().size();
  status_.publish();
  co_return true;
}

}  // namespace cell
