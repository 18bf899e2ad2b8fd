// How an Operation gets a person's word before anything moves: PROTOCOL.md, section 7. Each co_await stands
// alone in its statement, see drive.cpp.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>

#include "cs8_protocol/names.hpp"
#include "service/acquisition/operation.hpp"
#include "service/run/readiness.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// A refusal whose reason does not show in the controller's state is asked about again after this time.
constexpr auto kAskAgain = 10s;

}  // namespace

bool Operation::is_permitted() const {
  const auto permit = client_.latest_permit();  // that of the run before may not be back yet
  return client_.connected() && permit && permit->run == permit_number() &&
         permit->state == cs8::PermitState::kGranted;
}

/// A pass around the block is no run.
std::uint32_t Operation::permit_number() const {
  return passing_ ? 0 : static_cast<std::uint32_t>(run_->id());
}

void Operation::wait_for(const AwaitedAction* awaited) {
  const auto name = awaited ? std::optional(std::string(awaited->name)) : std::nullopt;
  if (status_.waiting_for == name) return;
  if (awaited) spdlog::info("waiting: {}", awaited->words);
  status_.waiting_for = name;
  publish();
}

void Operation::hear_permit(const cs8::Permit& permit) {
  if (asking_ && permit.state == cs8::PermitState::kAwaited) wait_for(&awaited_confirmation());
}

/// True once the run is confirmed; else another state was entered, by a fault or by a command.
asio::awaitable<bool> Operation::get_permission() {
  if (guided_ && !passing_) co_return true;  // nothing is commanded
  const State state = status_.state;
  const auto ready_by = std::chrono::steady_clock::now() + cell_.deadlines.ready;
  while (status_.state == state && !is_permitted()) {
    const auto told = client_.latest_state();
    asking_ = true;
    const cs8::PermitReply reply = co_await client_.begin(permit_number(), cell_.deadlines.confirm);
    asking_ = false;
    const auto* permit = std::get_if<cs8::Permit>(&reply);
    if (!permit) co_await wait_for_wake(20ms);  // the link is gone, and its loss is about to be told
    if (!permit || status_.state != state) continue;
    if (permit->reason == cs8::PermitReason::kNotConfirmed) {
      raise(not_ready_fault(awaited_confirmation()), Event::kNotReadyFault);
    } else if (permit->reason == cs8::PermitReason::kRefused) {
      const cs8::Rejected refused{static_cast<cs8::RejectReason>(permit->detail)};
      const AwaitedAction* awaited = awaited_after_rejection(refused.reason, told ? told->flags : 0);
      if (!awaited) {
        raise(fault_of(refused).fault, Event::kAbortFault);
      } else {
        wait_for(awaited);
        co_await wait_until_readier(told, ready_by);
        if (status_.state == state && std::chrono::steady_clock::now() >= ready_by)
          raise(not_ready_fault(*awaited), Event::kNotReadyFault);
      }
    }  // else granted, or taken away while it was awaited: asked for again
  }
  wait_for(nullptr);
  co_return status_.state == state;
}

/// Until the controller is not as it was told, another state is entered or it is time to ask again.
asio::awaitable<void> Operation::wait_until_readier(std::optional<cs8::State> told,
                                                    std::chrono::steady_clock::time_point at_latest) {
  const State state = status_.state;
  const auto until = std::min(at_latest, std::chrono::steady_clock::now() + kAskAgain);
  const auto is_as_told = [&] {
    const auto latest = client_.latest_state();
    return latest.has_value() == told.has_value() && (!told || readiness_of(*latest) == readiness_of(*told));
  };
  while (status_.state == state && client_.connected() && is_as_told() &&
         std::chrono::steady_clock::now() < until) {
    co_await wait_for_wake(1s);  // each state of the controller wakes
  }
}

}  // namespace cell
