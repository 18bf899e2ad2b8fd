// Each co_await stands alone in its statement, see cs8_controller.cpp. The permit is asked for in
// controller_permit.cpp.
#include "service/acquisition/controller_session.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "cs8_protocol/names.hpp"
#include "service/acquisition/link_fault.hpp"
#include "service/run/touch_command.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// Pauses between attempts to connect grow, to limit the attempts at a controller that is off.
constexpr auto kFirstPause = 100ms;
constexpr auto kLongestPause = 2000ms;

/// An arm that rests says so within this time.
constexpr auto kSettleMax = 10s;

/// "touchcal 1.2.3, VAL3 s7.7.2"
std::string application_text(const cs8::Welcome& welcome) {
  const auto parts = [](std::uint32_t version) {
    return fmt::format("{}.{}.{}", version / 10'000, version / 100 % 100, version % 100);
  };
  return fmt::format("{} {}, VAL3 s{}", cs8::text_of(welcome.application), parts(welcome.application_version),
                     parts(welcome.language_version));
}

}  // namespace

ControllerSession::ControllerSession(const Cell& cell, Controller& controller, PublishedStatus& status,
                                     Wake& wake, Clocks clocks)
    : cell_(cell), controller_(controller), status_(status), wake_(wake), clocks_(std::move(clocks)) {}

void ControllerSession::on_controller_state(const cs8::State& state) {
  // The two inputs of a probe may change up to 20 ms apart, the time between two states.
  inputs_disagree_count_ = cs8::probe_inputs(state.flags).agree() ? 0 : inputs_disagree_count_ + 1;
  const ControllerView& shown = status_.latest().controller;
  if (shown != view(shown.probe)) status_.publish();
  const bool watched = status_.state() == State::kResetting || status_.state() == State::kSuspended;
  if (watched || status_.latest().waiting_for) wake_.wake();
  if (is_active(status_.state()) && overruns_ && state.overruns > *overruns_)
    status_.warn({FaultCode::kControllerOverruns, fmt::format("{} since its start", state.overruns)});
  overruns_ = state.overruns;
  constexpr double kMovedRad = 1e-3;
  if (standing_ && status_.state() == State::kExecute && state.active_sequence == 0 &&
      (from_wire(state.joints) - *standing_).cwiseAbs().maxCoeff() > kMovedRad) {
    standing_.reset();
    status_.warn({FaultCode::kArmMoved, {}});
  }
  state_at_ = clocks_.steady();
}

void ControllerSession::check_task(const cs8::State& state) {
  if (std::exchange(task_error_, state.task_error) == state.task_error || state.task_error == 0) return;
  status_.raise({FaultCode::kTaskFailed, fmt::format("run-time error {}", state.task_error)},
                Event::kAbortFault);
}

void ControllerSession::stop() {
  ++stop_count_;
  controller_.stop();
}

void ControllerSession::on_entered(State state) {
  if (state == State::kStopping || state == State::kAborting) controller_.stop();
  if (asking_) controller_.finish();
}

ControllerView ControllerSession::view(const std::optional<std::string>& probe) const {
  ControllerView view{.connected = controller_.connected()};
  const auto state = controller_.latest_state();
  if (!view.connected || !state) return view;
  view.powered = (state->flags & cs8::kPowered) != 0;
  view.emergency_stop = state->emergency_stop != 0;
  view.mode = std::string(cs8::name(state->mode));
  view.cell_closed = (state->flags & cs8::kCellClosed) != 0;
  view.touch_tested = (state->flags & cs8::kTouchTested) != 0;
  view.permit = std::string(cs8::name(state->permit));
  const cs8::ProbeInputs inputs = cs8::probe_inputs(state->flags);
  if (inputs.agree()) {
    view.probe = inputs.free() ? "free" : "touched";
  } else {
    view.probe = inputs_disagree_count_ > 1 ? std::optional<std::string>("fault") : probe;
  }
  return view;
}

std::optional<std::int64_t> ControllerSession::data_age_ms() const {
  const auto heard = controller_.heard_at();
  if (!heard) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::milliseconds>(clocks_.steady() - *heard).count();
}

asio::awaitable<std::uint32_t> ControllerSession::connect(bool run_interrupted) {
  const State state = status_.state();
  const bool waits_for_reset = state == State::kAborted || state == State::kStopped;
  const cs8::ExpectedController expected{.arm = cell_.arm.name,
                                         .lower_limits = to_wire(cell_.arm.joint_ranges.lower),
                                         .upper_limits = to_wire(cell_.arm.joint_ranges.upper)};
  for (auto pause = std::chrono::milliseconds(kFirstPause); status_.state() == state && !status_.is_ending();
       pause = std::min(2 * pause, std::chrono::milliseconds(kLongestPause))) {
    const cs8::ConnectReply reply = co_await controller_.connect(expected);
    if (const auto* welcome = std::get_if<cs8::Welcome>(&reply)) {
      on_welcome(*welcome, state, run_interrupted);
      co_return waits_for_reset ? 0 : unsettled_sequence_;
    }
    const Fault fault = link_fault(std::get<cs8::LinkError>(reply));
    const auto& there = status_.fault();
    const bool keeps_fault = waits_for_reset && there;
    if (!keeps_fault && (!there || there->message() != fault.message()))
      status_.raise(fault, run_interrupted ? Event::kNotReadyFault : Event::kLinkDown);
    if (status_.state() == state && !status_.is_ending()) co_await wake_.wait(pause);
  }
  co_return 0;
}

void ControllerSession::on_welcome(const cs8::Welcome& welcome, State state, bool run_interrupted) {
  number_ = welcome.session;
  application_ = application_text(welcome);
  overruns_.reset();
  // A fault that ended a run stays until somebody has read it.
  if (status_.fault() && is_link_fault(status_.fault()->code) && state != State::kAborted)
    status_.clear_fault();
  if (state == State::kHeld && run_interrupted && !status_.fault())
    status_.set_fault({FaultCode::kDaemonRestarted, {}});
  status_.publish();
  unsettled_sequence_ = welcome.open_sequence;
}

std::uint32_t ControllerSession::sequence_to_settle() const {
  return open_touch_ ? open_touch_->sequence : unsettled_sequence_;
}

asio::awaitable<cs8::QueryReply> ControllerSession::query(std::uint32_t sequence) {
  return controller_.query(sequence, cell_.deadlines.command);
}

void ControllerSession::acknowledge(std::uint32_t sequence) {
  controller_.acknowledge(sequence);
  if (unsettled_sequence_ == sequence) unsettled_sequence_ = 0;
  open_touch_.reset();
}

asio::awaitable<bool> ControllerSession::travel(cs8::Travel command) {
  standing_.reset();
  const cs8::MoveReply reply = co_await controller_.travel(command);
  co_return take_move(reply);
}

bool ControllerSession::take_move(const cs8::MoveReply& reply) {
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    const OutcomeFault refused = fault_of(*rejected);
    const bool holds = refused.holds && status_.state() == State::kExecute;
    status_.raise(refused.fault, holds ? Event::kHoldFault : Event::kAbortFault);
    return false;
  }
  const auto* result = std::get_if<cs8::MoveResult>(&reply.answer);
  if (!result) return false;  // a lost link, which the controller's hook reports
  controller_.acknowledge(reply.sequence);
  if (result->outcome == cs8::Outcome::kArrived) return true;
  if (const auto fault = fault_of(result->outcome, result->phase, result->error_number)) {
    status_.raise(fault->fault, Event::kAbortFault);
  } else {
    expect_stop(result->outcome);
  }
  return false;
}

void ControllerSession::expect_stop(cs8::Outcome outcome) {
  const bool asked = status_.state() == State::kStopping || status_.state() == State::kAborting;
  if (outcome == cs8::Outcome::kStopped && asked) return;
  status_.raise(
      {FaultCode::kProtocolError, fmt::format("unexpected answer '{}' to a command", cs8::name(outcome))},
      Event::kAbortFault);
}

/// The controller's state, told after this call and at rest; nothing when the link is lost, another state was
/// entered or the arm does not come to rest.
asio::awaitable<std::optional<cs8::State>> ControllerSession::settled_state() {
  const State state = status_.state();
  const auto asked_at = clocks_.steady();
  while (controller_.connected() && status_.state() == state) {
    const auto told = controller_.latest_state();
    if (told && state_at_ > asked_at && (told->flags & cs8::kSettled) != 0) co_return told;
    if (clocks_.steady() > asked_at + kSettleMax)
      status_.raise({FaultCode::kMotionError, "the arm does not come to rest"}, Event::kAbortFault);
    co_await wake_.wait(20ms);
  }
  co_return std::nullopt;
}

asio::awaitable<std::optional<calib::JointVector>> ControllerSession::standing_joints() {
  if (standing_) co_return standing_;
  auto told = co_await settled_state();
  if (told && (told->flags & cs8::kRetractDue) != 0) {
    const State state = status_.state();
    const cs8::MoveReply reply = co_await controller_.retract(retract_command(cell_));
    take_move(reply);
    if (status_.state() != state) co_return std::nullopt;
    told = co_await settled_state();
  }
  if (!told) co_return std::nullopt;
  co_return from_wire(told->joints);
}

asio::awaitable<void> ControllerSession::leave_face() {
  const int stop_count = stop_count_;
  const auto told = co_await settled_state();
  if (!told || (told->flags & cs8::kRetractDue) == 0 || stop_count != stop_count_) co_return;
  const cs8::MoveReply reply = co_await controller_.retract(retract_command(cell_));
  const auto* result = std::get_if<cs8::MoveResult>(&reply.answer);
  if (result) controller_.acknowledge(reply.sequence);
  const bool arrived = result && result->outcome == cs8::Outcome::kArrived;
  spdlog::log(arrived ? spdlog::level::info : spdlog::level::warn, "the arm {} the face before the end",
              arrived ? "left" : "did not leave");
}

}  // namespace cell
