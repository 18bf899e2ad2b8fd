// When all touches of the plan are made, or as many as the run needs: each of them is held against what is
// known now.
#include <spdlog/spdlog.h>

#include <utility>

#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/touch_executor.hpp"
#include "service/run/decision_rule.hpp"

namespace cell {

namespace asio = boost::asio;

void TouchExecutor::tell_kept() {
  const auto kept = std::exchange(kept_, std::nullopt);
  if (!kept) return;
  const StoredTouch& touch = kept->touch;
  const bool polled = touch.source == cs8::CaptureSource::kPolled;
  spdlog::log(polled ? spdlog::level::warn : spdlog::level::info,
              "run {} touch {} on plane {}: {}{}, {} edge(s), overtravel {:.3f} mm", kept->run_id,
              touch.number, touch.plane, cs8::name(touch.source),
              polled ? ", late by up to 4 ms of its speed: check the latch" : "", kept->edges,
              cs8::metres_from_dmm(touch.overtravel_dmm) * 1e3);
}

void TouchExecutor::tell_left_out(const Run& run, int dropped) {
  if (dropped == 0) return;
  spdlog::info("run {} is accurate enough: {} touches are left out", run.id(), dropped);
  total_is_due_ = true;
  status_.publish();
}

/// A touch that came when little was known is contradicted only by those after it: it is made again, one at a
/// time and the worst first, since one bad touch can make others look bad.
asio::awaitable<void> TouchExecutor::end_touches(ActiveRun& active) {
  co_await identify(active);
  if (status_.state() != State::kExecute) co_return;
  const std::vector<int> left = suspects(active);
  if (suspect_one(active.run, left)) co_return;
  if (!left.empty()) status_.warn(outlier_.warning_of(left));
  if (active.run.next()) {
    co_await ask_for_block(active);
  } else {
    status_.apply(Event::kDone);
  }
}

asio::awaitable<void> TouchExecutor::ask_for_block(ActiveRun& active) {
  const bool is_held = co_await block_move_.ask(active);
  if (!is_held) co_return;
  held_by_ = HeldBy::kBlock;
  begin_place();
}

void TouchExecutor::begin_place() {
  reference_.begin_place();
  reference_ahead_.reset();
  stored_ahead_.reset();
  preparation_.drop_next();
}

void TouchExecutor::suspect_last(const ActiveRun& active) {
  const Run& run = active.run;
  const calib::PlannedTouch* planned = run.touches_made() > 0 ? run.planned(run.touches_made() - 1) : nullptr;
  if (!planned || run.moving_to() || run.place_of(planned->face) != run.place()) return;
  calib::OnlineArmEstimate with = preparation_.aim();
  if (!with.add(run.problem().touches.back()).contradicts) return;
  auto made = preparation_.aim_or_nominal(*planned);
  if (auto* aimed = std::get_if<calib::AimedTouch>(&made))
    outlier_.begin({run.touches_done(), std::move(*aimed), preparation_.aim()});
}

void TouchExecutor::warn_of_outliers(ActiveRun& active) {
  const std::vector<int> left = suspects(active);
  if (!left.empty()) status_.warn(outlier_.warning_of(left));
}

std::vector<int> TouchExecutor::suspects(ActiveRun& active) {
  preparation_.add_contacts(active.run);
  return suspects_of(active.run.latest(), preparation_.aim());
}

/// Begins to make one of them again; false when there is none, or so many that no touch is to be trusted:
/// then the verdict says so.
bool TouchExecutor::suspect_one(const Run& run, const std::vector<int>& suspects) {
  if (static_cast<double>(suspects.size()) > kRejectedShareMax * run.touches_done()) return false;
  for (const int number : suspects) {
    const calib::PlannedTouch* planned = run.planned(static_cast<std::size_t>(number - 1));
    if (!planned || run.place_of(planned->face) != run.place()) continue;  // the block stands there no more
    if (outlier_.was_made_again(number)) continue;
    auto made = preparation_.aim_or_nominal(*planned);
    auto* aimed = std::get_if<calib::AimedTouch>(&made);
    if (!aimed) continue;
    outlier_.begin({number, std::move(*aimed), preparation_.aim(), true});
    return true;
  }
  return false;
}

}  // namespace cell
