// How a ControllerSession obtains a person's confirmation before anything moves. Each co_await stands alone
// in its statement, see cs8_controller.cpp.
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "cs8_protocol/names.hpp"
#include "service/acquisition/controller_session.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// A refusal whose reason does not show in the controller's state is asked about again after this time.
constexpr auto kAskAgain = 10s;

asio::awaitable<cs8::TouchReply> not_sent(cs8::TouchReply reply) { co_return reply; }

}  // namespace

bool ControllerSession::has_permit(std::uint32_t run_number) const {
  const auto permit = controller_.latest_permit();  // that of the run before may not be back yet
  return !is_doubted_ && controller_.connected() && permit && permit->run == run_number &&
         permit->state == cs8::PermitState::kGranted;
}

std::optional<cs8::Rejected> ControllerSession::refusal_without_permit() const {
  // a lost link says so itself
  if (!controller_.connected() || (permitted_run_ && has_permit(*permitted_run_))) return std::nullopt;
  const auto permit = controller_.latest_permit();
  const auto state = permit ? permit->state : cs8::PermitState::kNone;
  return cs8::Rejected{cs8::RejectReason::kNotPermitted, static_cast<std::int32_t>(state)};
}

asio::awaitable<cs8::TouchReply> ControllerSession::touch(cs8::Touch command) {
  stop_sent_ = false;
  if (const auto refusal = refusal_without_permit()) return not_sent({0, *refusal});
  return controller_.touch(command);
}

void ControllerSession::wait_for(const AwaitedAction* awaited) {
  const auto name = awaited ? std::optional(std::string(awaited->name)) : std::nullopt;
  if (awaited && status_.latest().waiting_for != name) spdlog::info("waiting: {}", awaited->words);
  status_.wait_for(name);
}

void ControllerSession::give_permit_back() {
  permitted_run_.reset();
  controller_.finish();
}

Fault ControllerSession::with_permission_told(Fault fault) const {
  if (fault.code != FaultCode::kPermissionLost) return fault;
  const auto add = [&fault](const std::string& words) {
    if (words.empty() || fault.detail.find(words) != std::string::npos) return;
    fault.detail += (fault.detail.empty() ? "" : "; ") + words;
  };
  if (const auto state = controller_.latest_state()) add(cell::lost_permission(*state));
  const auto permit = controller_.latest_permit();
  if (permit && permit->state != cs8::PermitState::kGranted)
    add(fmt::format("the permit ended by '{}'", cs8::name(permit->reason)));
  return fault;
}

void ControllerSession::end_permit() {
  is_doubted_ = true;  // until another is asked for: that this one ended is told later
  give_permit_back();
}

void ControllerSession::on_permit(const cs8::Permit& permit) {
  if (permitted_run_ && permit.state != cs8::PermitState::kGranted)
    spdlog::warn("the controller changed the permit of run {} to {}: {}", permit.run, cs8::name(permit.state),
                 cs8::name(permit.reason));
  if (asking_ && permit.state == cs8::PermitState::kAwaited) wait_for(&awaited_confirmation());
}

asio::awaitable<bool> ControllerSession::obtain_permit(std::uint32_t run_number) {
  const State state = status_.state();
  const auto ready_by = clocks_.steady() + cell_.deadlines.ready;
  inputs_disagreed_ = false;
  permitted_run_.reset();  // each refusal from here on is an answer, no loss
  const auto is_needless = [this, state] {
    const auto told = controller_.latest_state();
    return state == State::kResetting && told && (told->flags & cs8::kRetractDue) == 0;
  };
  while (status_.state() == state && !has_permit(run_number) && !is_needless()) {
    const auto told = controller_.latest_state();
    asking_ = true;
    const cs8::PermitReply reply = co_await controller_.begin(run_number, cell_.deadlines.confirm);
    asking_ = false;
    is_doubted_ = false;
    const auto* permit = std::get_if<cs8::Permit>(&reply);
    if (!permit) co_await wake_.wait(20ms);  // the link is lost; its hook is about to report it
    if (!permit || status_.state() != state) continue;
    if (permit->reason == cs8::PermitReason::kNotConfirmed) {
      status_.raise(not_ready_fault(awaited_confirmation()), Event::kNotReadyFault);
    } else if (permit->reason == cs8::PermitReason::kRefused) {
      co_await take_refused_permit(*permit, told, ready_by);
    }  // else granted, or taken away while it was awaited: asked for again
  }
  wait_for(nullptr);
  permission_ = {};
  if (status_.state() == state && has_permit(run_number)) permitted_run_ = run_number;
  co_return permitted_run_.has_value();
}

/// Waits for what a person at the cell can fix. Anything else ends a start; a run on hold stays there.
asio::awaitable<void> ControllerSession::take_refused_permit(const cs8::Permit& permit,
                                                             std::optional<cs8::State> told,
                                                             std::chrono::steady_clock::time_point ready_by) {
  const State state = status_.state();
  cs8::Rejected refused{static_cast<cs8::RejectReason>(permit.detail)};
  if (told && refused.reason == cs8::RejectReason::kTaskFailed) refused.detail = told->task_error;
  const AwaitedAction* awaited = awaited_after_rejection(refused.reason, told ? told->flags : 0);
  if (!awaited) {
    const OutcomeFault failed = fault_of(refused);
    const bool ends = state == State::kResetting || (state == State::kStarting && !failed.holds);
    status_.raise(failed.fault, ends ? Event::kAbortFault : Event::kNotReadyFault);
    meet_anew_after(refused);
    co_return;
  }
  // A hand on the stylus of which only one wire knows is no touch test: the other is cut or shorted.
  if (awaited == &awaited_touch_test() && inputs_disagreed_)
    awaited = awaited_after_rejection(cs8::RejectReason::kProbeInputs, 0);
  wait_for(awaited);
  co_await wait_until_readier(told, ready_by);
  if (status_.state() == state && clocks_.steady() >= ready_by)
    status_.raise(not_ready_fault(*awaited), Event::kNotReadyFault);
}

/// Waits until the controller's state changes, another state is entered or it is time to ask again.
asio::awaitable<void> ControllerSession::wait_until_readier(std::optional<cs8::State> told,
                                                            std::chrono::steady_clock::time_point at_latest) {
  const State state = status_.state();
  const auto until = std::min(at_latest, clocks_.steady() + kAskAgain);
  const auto is_as_told = [&] {
    const auto latest = controller_.latest_state();
    return latest.has_value() == told.has_value() && (!told || readiness_of(*latest) == readiness_of(*told));
  };
  while (status_.state() == state && controller_.connected() && is_as_told() && clocks_.steady() < until) {
    co_await wake_.wait(1s);  // each state of the controller wakes
  }
}

}  // namespace cell
