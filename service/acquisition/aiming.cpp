// Which touch an Operation makes next, aimed with what the touches before it told, and the way there.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "calib_core/units.hpp"
#include "service/acquisition/operation.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

void Operation::begin_aim() {
  aim_.emplace(planning_);
  ahead_.reset();
}

/// The touches that the aim does not know yet.
void Operation::learn() {
  const std::vector<calib::Touch>& touches = run_->problem().touches;
  while (aim_ && aim_->touch_count() < touches.size()) {
    const calib::AimedContact contact = aim_->add(touches[aim_->touch_count()]);
    spdlog::log(contact.contradicts ? spdlog::level::warn : spdlog::level::info,
                "run {} touch {} was {:.2f} mm from where it was expected, {:.2f} mm predicted{}", run_->id(),
                aim_->touch_count(), calib::mm_from_metres(contact.miss_m),
                calib::mm_from_metres(contact.predicted_miss_m),
                contact.contradicts ? ": the other touches contradict it, it does not aim" : "");
  }
}

/// Where the arm leaves from: as the last touch was made, which may have been one of the run before. That run
/// knew the arm better than this one does at its beginning, and may have been broken off near to something.
calib::TransferEnd Operation::leaving(const calib::JointVector& joints) const {
  constexpr double kSamePostureRad = 1e-4;
  if (!made_) return {joints, std::nullopt, nullptr};
  if ((joints - made_->touch.clear_joints).cwiseAbs().maxCoeff() > kSamePostureRad)
    return {joints, std::nullopt, &made_->problem};
  return calib::end_of(*made_);
}

std::optional<Operation::PreparedTouch> Operation::with_way(std::variant<calib::AimedTouch, std::string> made,
                                                            const calib::TransferEnd& from) const {
  auto* aimed = std::get_if<calib::AimedTouch>(&made);
  if (!aimed) {
    spdlog::info("a touch cannot be made as it is aimed now: {}", std::get<std::string>(made));
    return std::nullopt;
  }
  auto via = calib::find_aimed_transfer(planning_, *aim_, from, calib::end_of(*aimed));
  if (!via) {
    spdlog::info("no way to a touch on plane {} as it is aimed now", aimed->touch.face + 1);
    return std::nullopt;
  }
  return PreparedTouch{std::move(*aimed), std::move(*via)};
}

/// The touch at this place of the plan. One that cannot be made as it is aimed is made with the nominal miss,
/// so that the plan's order stays; when there is no way to that either, it comes behind the others, once.
/// Nothing when it cannot be made then.
std::optional<Operation::PreparedTouch> Operation::prepared(std::size_t index,
                                                            const calib::TransferEnd& from) {
  while (const calib::PlannedTouch* planned = run_->planned(index)) {
    if (auto touch = with_way(calib::aim_touch(planning_, *aim_, *planned), from)) return touch;
    if (auto touch = with_way(calib::nominal_touch(planning_, *planned), from)) return touch;
    if (!run_->put_off(index)) break;
  }
  return std::nullopt;
}

/// True when the next touch is ready to be commanded; false when there is none or another state was entered.
asio::awaitable<bool> Operation::prepare_touch() {
  if (standing_ && ahead_) co_return true;
  ahead_.reset();
  identify();
  learn();
  const auto from = co_await standing_joints();
  if (status_.state != State::kExecute) co_return false;
  if (!from) {
    co_await wait_for_wake(20ms);  // the link is gone, and its loss is about to be told
    co_return false;
  }
  ahead_ = prepared(run_->touches_made(), leaving(*from));
  if (!ahead_) {
    const int plane = run_->next()->face + 1;
    raise({FaultCode::kNoSafeWay, fmt::format("to touch {} on plane {}", run_->touches_done() + 1, plane)},
          Event::kAbortFault);
  }
  co_return ahead_.has_value();
}

/// While the arm makes made_: the touch behind it.
void Operation::look_ahead() {
  const std::size_t behind = run_->touches_made() + 1;
  stop_when_good_enough(behind);
  ahead_ = prepared(behind, calib::end_of(*made_));
}

/// A run that reached the accuracy it was asked for leaves out the touches that it would still fit.
void Operation::stop_when_good_enough(std::size_t first) {
  if (!run_->is_good_enough()) return;
  const int dropped = run_->drop_fitted(first);
  if (dropped == 0) return;
  spdlog::info("run {} is accurate enough: {} touches are left out", run_->id(), dropped);
  try {
    store_.set_touches_total(run_->id(), run_->touches_total());
  } catch (const std::exception& error) {
    raise({FaultCode::kStoreFailed, error.what()}, Event::kAbortFault);
  }
  publish();
}

}  // namespace cell
