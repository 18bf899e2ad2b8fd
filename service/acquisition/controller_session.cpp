// Each co_await stands alone in its statement, see cs8_controller.cpp. The permit is asked for in
// controller_permit.cpp.
#include "service/acquisition/controller_session.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "calib_core/geometry/units.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "service/acquisition/link_fault.hpp"

namespace cell {

namespace asio = boost::asio;
using namespace std::chrono_literals;

namespace {

/// More different faults of the link than this in a row are not told apart.
constexpr std::size_t kToldFaultsMax = 16;

/// The two inputs of a probe may change up to 20 ms apart, the time between two states.
constexpr int kDisagreementsMax = 1;

/// An arm that rests says so within this time.
constexpr auto kSettleMax = 10s;

/// What a person reads of a run that is over, and how it ended, stays while the link comes and goes.
bool is_over(State state) { return has_ended(state) || state == State::kComplete; }

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
  const cs8::ProbeInputs inputs = cs8::probe_inputs(state.flags);
  inputs_disagree_count_ = inputs.agree() ? 0 : inputs_disagree_count_ + 1;
  if (inputs.agree() && !inputs.free()) inputs_disagreed_ = false;  // both wires know of the hand
  if (inputs_disagree_count_ > kDisagreementsMax) inputs_disagreed_ = true;
  const ControllerView& shown = status_.latest().controller;
  if (shown != view(shown.probe)) status_.publish();
  const bool watched = status_.state() == State::kResetting || status_.state() == State::kSuspended;
  const bool other_readiness = std::exchange(readiness_, readiness_of(state)) != readiness_of(state);
  if (watched || other_readiness || status_.latest().waiting_for) wake_.wake();
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
  told_at_ = *state_at_;
  if (is_watched()) permission_.on_state(state, *state_at_);
  hold_without_permission();
}

bool ControllerSession::is_moving_state() const {
  return status_.state() == State::kExecute || status_.state() == State::kCompleting;
}

/// With a permit the arm moves in STARTING on the way around the block, in RESETTING on the way back.
bool ControllerSession::is_watched() const {
  const State state = status_.state();
  return permitted_run_ && (is_moving_state() || state == State::kStarting || state == State::kResetting);
}

void ControllerSession::on_heartbeat() {
  if (is_watched()) permission_.on_heartbeat();
  hold_without_permission();
}

/// The arm is told to stop: a controller that lost the permission and moves all the same is not to be
/// trusted. What was lost stays known until the next permit: the touch under way may be answered after this.
void ControllerSession::hold_without_permission() {
  if (!is_watched()) return;
  auto fault = permission_.fault(clocks_.steady());
  if (!fault) return;
  is_doubted_ = true;
  stop_motion();
  status_.raise(with_permission_told(*std::move(fault)), hold_or_abort());
}

std::optional<Fault> ControllerSession::search_fault(std::span<const calib::PlannedTouch> touches) const {
  const std::int32_t speed_um_s = cs8::um_s_from_metres_per_second(cell_.speeds.search_m_s);
  if (search_speed_max_um_s_ > 0 && speed_um_s > search_speed_max_um_s_) {
    return Fault{FaultCode::kPlanInvalid,
                 fmt::format("searches at {} um/s, and the controller takes {} at most", speed_um_s,
                             search_speed_max_um_s_)};
  }
  if (!search_length_max_m()) return std::nullopt;
  for (std::size_t i = 0; i < touches.size(); ++i) {
    if (cs8::dmm_from_metres(touches[i].search_length_m) <= search_length_max_dmm_) continue;
    return Fault{FaultCode::kPlanInvalid,
                 fmt::format("touch {} searches over {:.1f} mm, and the controller takes {:.1f} at most",
                             i + 1, calib::mm_from_metres(touches[i].search_length_m),
                             calib::mm_from_metres(*search_length_max_m()))};
  }
  return std::nullopt;
}

std::optional<double> ControllerSession::search_length_max_m() const {
  if (search_length_max_dmm_ <= 0) return std::nullopt;
  return cs8::metres_from_dmm(search_length_max_dmm_);
}

void ControllerSession::check_task(const cs8::State& state, Event event) {
  if (std::exchange(task_error_, state.task_error) == state.task_error || state.task_error == 0) return;
  status_.raise({FaultCode::kTaskFailed, fmt::format("run-time error {}", state.task_error)}, event);
}

void ControllerSession::stop() {
  ++stop_count_;
  controller_.stop();
}

void ControllerSession::stop_motion() {
  stop_sent_ = true;
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
  // The controller says so through all of a touch: it is due where a command has ended without it.
  view.retract_due = (state->flags & cs8::kRetractDue) != 0 && state->active_sequence == 0;
  const cs8::ProbeInputs inputs = cs8::probe_inputs(state->flags);
  if (inputs.agree()) {
    view.probe = inputs.free() ? "free" : "touched";
  } else {
    view.probe = inputs_disagree_count_ > kDisagreementsMax ? std::optional<std::string>("fault") : probe;
  }
  return view;
}

std::optional<std::int64_t> ControllerSession::data_age_ms() const {
  const std::chrono::steady_clock::time_point told_at = told_at_;
  if (told_at == std::chrono::steady_clock::time_point::min()) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::milliseconds>(clocks_.steady() - told_at).count();
}

asio::awaitable<std::uint32_t> ControllerSession::connect(bool run_interrupted,
                                                          std::function<bool()> gives_up) {
  const State state = status_.state();
  const cs8::ExpectedController expected{.arm = cell_.arm.name,
                                         .lower_limits = to_wire(cell_.arm.joint_ranges.lower),
                                         .upper_limits = to_wire(cell_.arm.joint_ranges.upper)};
  while (status_.state() == state && !status_.is_ending() && !(gives_up && gives_up())) {
    const auto pause = std::chrono::ceil<std::chrono::milliseconds>(pause_.earliest() - clocks_.steady());
    if (pause > 0ms) {
      co_await wake_.wait(pause);
      continue;
    }
    const cs8::ConnectReply reply = co_await controller_.connect(expected);
    pause_.on_try(clocks_.steady(), std::holds_alternative<cs8::Welcome>(reply));
    if (const auto* welcome = std::get_if<cs8::Welcome>(&reply)) {
      on_welcome(*welcome, state, run_interrupted);
      co_return unsettled_sequence_;
    }
    const Fault fault = link_fault(std::get<cs8::LinkError>(reply));
    const auto& there = status_.fault();
    const bool keeps_fault =
        there && (is_over(state) || (state == State::kHeld && (!run_interrupted || explains_hold(*there))));
    if (!keeps_fault && (!there || there->message() != fault.message()))
      raise_link_fault(fault, run_interrupted ? Event::kNotReadyFault : Event::kLinkDown);
  }
  co_return 0;
}

void ControllerSession::close() {
  controller_.close();
  pause_.on_link_end(clocks_.steady());
}

void ControllerSession::on_link_lost(const cs8::LinkError& error, Event event) {
  standing_.reset();
  permitted_run_.reset();
  loss_ = link_fault(error);
  pause_.on_link_end(clocks_.steady());
  if (pause_.short_links() == 0) told_faults_.clear();
  // A person reads why a run ended or is on hold, and how it ended, to the end.
  const State state = status_.state();
  const auto& there = status_.fault();
  const bool is_held =
      state == State::kHolding ||
      (state == State::kHeld && (event == Event::kLinkDown || (there && explains_hold(*there))));
  const bool is_told = there && there->code != FaultCode::kStateMissing;  // which this is the reason of
  if ((is_over(state) || is_held) && is_told) {
    spdlog::warn("{}", link_fault(error).message());
    status_.publish();
  } else {
    raise_link_fault(link_fault(error), event);
  }
}

/// A controller that takes one link after the other and loses it fills no table: while no link lasts, each of
/// its faults is kept once, and again with the number of links when that has become ten times as large.
void ControllerSession::raise_link_fault(Fault fault, Event event) {
  if (told_faults_.size() >= kToldFaultsMax) told_faults_.clear();
  const bool is_new = told_faults_.insert(fault.message()).second;
  const int count = pause_.short_links();
  bool is_round = count > 1;
  for (int rest = count; rest > 1; rest /= 10) is_round = is_round && rest % 10 == 0;
  if (count > 1) fault.detail += fmt::format(" ({} short links in a row)", count);
  const bool may_move = is_active(status_.state()) && status_.state() != State::kHeld;
  if (is_new || is_round || may_move) {
    status_.raise(std::move(fault), event);
  } else {
    status_.show(std::move(fault), event);
  }
}

void ControllerSession::on_welcome(const cs8::Welcome& welcome, State state, bool run_interrupted) {
  number_ = welcome.session;
  application_ = application_text(welcome);
  overruns_.reset();
  asking_ = false;
  permitted_run_.reset();
  search_length_max_dmm_ = welcome.search_length_max_dmm;
  search_speed_max_um_s_ = welcome.search_speed_max_um_s;
  // A fault that ended a run or holds it stays until somebody has read it.
  const bool stays = state == State::kAborted || (state == State::kHeld && !run_interrupted);
  if (status_.fault() && is_link_fault(status_.fault()->code) && !stays) status_.clear_fault();
  // That the controller could not be reached is over; what holds the run is that the link was lost.
  const bool was_unreachable = status_.fault() && status_.fault()->code == FaultCode::kControllerUnreachable;
  if (state == State::kHeld && was_unreachable && loss_) status_.set_fault(*loss_);
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

void ControllerSession::discard(std::optional<std::int64_t> run_id, std::uint32_t sequence,
                                const cs8::TouchResult& result) {
  if (result.outcome == cs8::Outcome::kContact) {
    spdlog::warn(
        "{}: the contact of command {} is no measurement: joints {} microdegrees, overtravel {} dmm, {} "
        "edges",
        run_id ? fmt::format("run {}", *run_id) : "no run is stored", sequence,
        fmt::join(result.contact, " "), result.overtravel_dmm, result.edges);
  }
  acknowledge(sequence);
}

asio::awaitable<bool> ControllerSession::travel(cs8::Travel command) {
  standing_.reset();
  stop_sent_ = false;
  if (const auto refusal = refusal_without_permit()) co_return take_move({0, *refusal});
  const cs8::MoveReply reply = co_await controller_.travel(command);
  co_return take_move(reply);
}

bool ControllerSession::take_move(const cs8::MoveReply& reply) {
  if (const auto* rejected = std::get_if<cs8::Rejected>(&reply.answer)) {
    const OutcomeFault refused = fault_of(*rejected);
    status_.raise(with_permission_told(refused.fault), event_of(refused));
    meet_anew_after(*rejected);
    return false;
  }
  const auto* result = std::get_if<cs8::MoveResult>(&reply.answer);
  if (!result) return false;  // a lost link, which the controller's hook reports
  controller_.acknowledge(reply.sequence);
  if (result->outcome == cs8::Outcome::kArrived) return true;
  if (const auto fault = fault_of(result->outcome, result->phase, result->error_number)) {
    status_.raise(with_permission_told(fault->fault), event_of(*fault));
  } else {
    expect_stop(result->outcome);
  }
  return false;
}

void ControllerSession::expect_stop(cs8::Outcome outcome) {
  const bool asked = stop_sent_ || status_.state() == State::kStopping || status_.state() == State::kAborting;
  if (outcome == cs8::Outcome::kStopped && asked) return;
  status_.raise(
      {FaultCode::kProtocolError, fmt::format("unexpected answer '{}' to a command", cs8::name(outcome))},
      hold_or_abort());
}

void ControllerSession::meet_anew_after(const cs8::Rejected& rejected) {
  using enum cs8::RejectReason;
  const bool is_unlike = rejected.reason == kResultUnacknowledged || rejected.reason == kBusy ||
                         rejected.reason == kStaleSequence;
  if (is_unlike) close();
}

/// The controller's state, told after this call and at rest; nothing when the link is lost, another state was
/// entered or the arm does not come to rest.
asio::awaitable<std::optional<cs8::State>> ControllerSession::settled_state() {
  const State state = status_.state();
  const auto asked_at = clocks_.steady();
  while (controller_.connected() && status_.state() == state) {
    const auto told = controller_.latest_state();
    if (told && state_at_ && *state_at_ > asked_at && (told->flags & cs8::kSettled) != 0) co_return told;
    if (clocks_.steady() > asked_at + kSettleMax)
      status_.raise({FaultCode::kMotionError, "the arm does not come to rest"}, Event::kAbortFault);
    co_await wake_.wait(20ms);
  }
  co_return std::nullopt;
}

/// A run keeps its touches; the way around the block and the way back have none and begin anew.
Event ControllerSession::hold_or_abort() const {
  return is_moving_state() ? Event::kHoldFault : Event::kAbortFault;
}

/// Of a move. Only among touches something goes on by itself.
Event ControllerSession::event_of(const OutcomeFault& fault) const {
  const bool keeps_touches = is_moving_state() || status_.state() == State::kHolding;  // State told it first
  if (!keeps_touches || !(fault.holds || fault.suspends)) return Event::kAbortFault;
  return status_.state() == State::kExecute ? fault.event() : Event::kHoldFault;
}

bool ControllerSession::may_retract() const {
  const auto permit = controller_.latest_permit();
  return permit &&
         (permit->state == cs8::PermitState::kGranted || permit->state == cs8::PermitState::kRetractOnly);
}

asio::awaitable<std::optional<calib::JointVector>> ControllerSession::standing_joints() {
  if (standing_) co_return standing_;
  auto told = co_await settled_state();
  if (told && (told->flags & cs8::kRetractDue) != 0) {
    const State state = status_.state();
    if (!may_retract()) {  // ended in this moment: the controller would refuse the command
      status_.raise(with_permission_told({FaultCode::kPermissionLost, "before the way back from the face"}),
                    hold_or_abort());
      co_return std::nullopt;
    }
    stop_sent_ = false;
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
  if (!may_retract()) {
    spdlog::warn("the arm stays at the face: there is no permit any more for the way back");
    co_return;
  }
  const cs8::MoveReply reply = co_await controller_.retract(retract_command(cell_));
  const auto* result = std::get_if<cs8::MoveResult>(&reply.answer);
  if (result) controller_.acknowledge(reply.sequence);
  const bool arrived = result && result->outcome == cs8::Outcome::kArrived;
  spdlog::log(arrived ? spdlog::level::info : spdlog::level::warn, "the arm {} the face before the end",
              arrived ? "left" : "did not leave");
}

}  // namespace cell
