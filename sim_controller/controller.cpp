#include "sim_controller/controller.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cs8_protocol/codec.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/readiness.hpp"
#include "sim_controller/reports.hpp"
#include "sim_controller/trouble_effects.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::PermitReason;
using cs8::PermitState;
using cs8::RejectReason;

/// At speed max no event simulates more than this: a longer motion continues with the next event.
constexpr int kTicksAtOnceMax = static_cast<int>(600.0 / kTickSeconds);

TimePoint::duration tick_period(double speed) {
  return std::chrono::ceil<TimePoint::duration>(std::chrono::duration<double>(kTickSeconds / speed));
}

/// One step: the state it changes and what it sends.
class Step {
 public:
  Step(const Plant& plant, ControllerState& state, TimePoint now) : plant_(plant), state_(state), now_(now) {}

  void operator()(const ConnectionOpened&) {
    advance();
    state_.connected = true;
    state_.greeted = false;
    state_.heartbeat_timeout = kHelloTimeout;
    state_.last_heard = now_;
  }

  void operator()(const ConnectionClosed&) {
    advance();
    lose_link();
  }

  void operator()(const Tick& tick) {
    if (tick.bytes_waiting) state_.last_heard = now_;
    advance();
    report_state();
  }

  void operator()(const cs8::Message& message) {
    state_.last_heard = now_;
    advance();
    if (!state_.connected) return;  // it was cut before this came: nobody reads an answer
    const cs8::MessageType type = cs8::type_of(message);
    if (!state_.greeted && type != cs8::MessageType::kHello) return fault(cs8::FaultCode::kNoHandshake, 0);
    if (cs8::is_from_controller(type))
      return fault(cs8::FaultCode::kWrongSide, static_cast<std::int32_t>(type));
    std::visit([&](const auto& payload) { take(message.sequence, payload); }, message.payload);
    report_state();
  }

  Replies replies;

 private:
  // ---- messages ----

  void take(std::uint32_t, const cs8::Hello& hello) {
    if (state_.greeted) end_permit_of_link();  // whoever says it again
    state_.greeted = true;
    state_.heartbeat_timeout = std::clamp(std::chrono::milliseconds(hello.heartbeat_timeout_ms),
                                          kHeartbeatTimeoutMin, state_.heartbeat_timeout_max);
    state_.next_state = now_ + kStatePeriod;
    if (state_.operator_called) called_to_free_arm(state_.person);
    state_.operator_called = false;
    send(0, welcome(plant_, state_, open_sequence(), now_));
  }

  void take(std::uint32_t, const cs8::Heartbeat&) {}
  void take(std::uint32_t, const cs8::Begin& begin) {
    if (const auto reason = refusal_of_begin(state_)) {
      // A new run while one moves: the permit goes, and with it the motion.
      if (running()) break_off(state_.cabinet, *running(), Outcome::kStopped);
      tell(refuse(state_.permit, begin, *reason));
      if (*reason == RejectReason::kTouchTestMissing) asked_for_touch_test(state_.person);
      return;
    }
    tell(await(state_.permit, begin, now_));
    asked_to_confirm(state_.person);
  }

  void take(std::uint32_t, const cs8::Finish&) {
    if (state_.permit.permit.state == PermitState::kNone) return;
    if (running()) break_off(state_.cabinet, *running(), Outcome::kStopped);
    tell(withdraw(state_.permit, PermitReason::kFinished));
  }

  void take(std::uint32_t sequence, const cs8::Touch& command) {
    if (admit(sequence, command)) start(command, begin_touch(plant_, state_.cabinet, sequence, command));
  }

  void take(std::uint32_t sequence, const cs8::Travel& command) {
    if (admit(sequence, command)) start(command, begin_travel(plant_, state_.cabinet, sequence, command));
  }

  void take(std::uint32_t sequence, const cs8::Retract& command) {
    if (!admit(sequence, command)) return;
    start(command, begin_retract(plant_, state_.cabinet, state_.motion.retract_path, sequence, command));
  }

  void take(std::uint32_t, const cs8::Stop&) {
    if (running()) break_off(state_.cabinet, *running(), Outcome::kStopped);
  }

  void take(std::uint32_t, const cs8::ResultQuery& query) {
    if (query.command_sequence == open_sequence() && query.command_sequence != 0) {
      repeat_answer();
    } else {
      send(query.command_sequence, cs8::ResultUnknown{query.command_sequence});
    }
  }

  void take(std::uint32_t, const cs8::ResultAcknowledge& acknowledge) {
    if (state_.stored_result && state_.stored_result->sequence == acknowledge.command_sequence) {
      state_.stored_result.reset();
    }
  }

  template <class FromController>
  void take(std::uint32_t, const FromController&) {}

  // ---- admission ----

  std::optional<RunningCommand>& running() { return state_.motion.running; }

  std::uint32_t open_sequence() {
    if (running()) return running()->sequence;
    return state_.stored_result ? state_.stored_result->sequence : 0;
  }

  void repeat_answer() {
    if (running()) {
      send(running()->sequence, cs8::Accepted{});
    } else {
      replies.messages.push_back(*state_.stored_result);
    }
  }

  /// Answers a repeated or refused command; true when it is to be carried out.
  template <class Command>
  bool admit(std::uint32_t sequence, const Command& command) {
    if (sequence != 0 && sequence == open_sequence()) {
      repeat_answer();
      return false;
    }
    constexpr bool kIsRetract = Command::kType == cs8::MessageType::kRetract;
    auto rejected = refusal_of_motion(state_, sequence, kIsRetract);
    if (!rejected) rejected = refusal(plant_, command);
    if (!rejected && !kIsRetract) rejected = probe_refusal(state_.cabinet);
    if (rejected) send(sequence, *rejected);
    return !rejected;
  }

  template <class Command>
  void start(const Command& command, RunningCommand begun) {
    begun.deadline = now_ + std::chrono::milliseconds(command.deadline_ms);
    state_.last_sequence = begun.sequence;
    send(begun.sequence, cs8::Accepted{});
    running() = std::move(begun);
  }

  // ---- time ----

  /// Ticks and what is due between them until now, in the order in which it was due.
  void advance() {
    if (std::isinf(state_.speed)) {
      links_until(now_);
      for (int i = 0; i < kTicksAtOnceMax && !rests(); ++i) tick_at(now_);
      return;
    }
    const auto period = tick_period(state_.speed);
    while (state_.next_tick <= now_) {
      links_until(state_.next_tick);
      if (rests()) {
        const TimePoint until = std::min(now_, next_link_event());
        const auto ticks = std::max<std::int64_t>(1, (until - state_.next_tick) / period);
        rest(plant_, state_.cabinet, ticks);
        state_.next_tick += ticks * period;
      } else {
        tick_at(state_.next_tick);
        state_.next_tick += period;
      }
    }
    links_until(now_);
  }

  /// Nothing moves and nobody does anything: ticks change nothing but the warmth.
  bool rests() {
    const Cabinet& cabinet = state_.cabinet;
    const bool inputs_known = cabinet.probe_free() || cabinet.probe_touched() || cabinet.probe_disagrees();
    return !running() && is_empty(cabinet.drives) && is_settled(cabinet.drives) && inputs_known &&
           state_.person.plan.empty() && !state_.plan.waits() && cabinet.world.probe.bounce_steps == 0 &&
           cabinet.world.probe.vibration_steps == 0 && cabinet.world.probe.troubles.vibration_s <= 0.0 &&
           looked_at_;
  }

  TimePoint silent_at() const { return state_.last_heard + state_.heartbeat_timeout; }

  TimePoint next_link_event() const {
    TimePoint next = TimePoint::max();
    if (state_.connected) next = silent_at();
    if (state_.permit.permit.state == PermitState::kAwaited) next = std::min(next, state_.permit.confirm_by);
    return next;
  }

  /// Silence, deadlines and confirmations that are over at a wall time.
  void links_until(TimePoint at) {
    if (state_.connected && at >= silent_at()) {
      lose_link();
      replies.close = true;
    }
    if (running() && at >= running()->deadline) break_off(state_.cabinet, *running(), Outcome::kDeadline);
    tell(expire(state_.permit, at));
  }

  void tick_at(TimePoint at) {
    looked_at_ = true;
    apply_due_faults();
    Cabinet& cabinet = state_.cabinet;
    tick(plant_, state_.person, cabinet);
    const CabinetTick seen = tick(plant_, cabinet);
    if (cabinet.jogged) {  // an operator took the way out over
      cabinet.jogged = false;
      state_.motion.retract_path.clear();
    }
    // A collision takes the power too: its command ends with that cause before the permission is looked at.
    const auto carry_out = [&] {
      if (running() && step(plant_, cabinet, state_.motion, seen, at)) finish();
    };
    if (seen.sensed.collision) carry_out();
    watch_permission();
    if (!seen.sensed.collision) carry_out();
    tell(watch_key(state_.permit, cabinet.panel.confirm_key));
  }

  /// What goes wrong in this tick.
  void apply_due_faults() {
    const bool is_touch = running() && std::holds_alternative<cs8::Touch>(running()->order);
    state_.plan.on_touch_phase(is_touch ? running()->sequence : 0,
                               is_touch ? phase_of(running()->stage) : cs8::Phase::kIdle);
    for (const InjectedEvent& due : state_.plan.advance(kTickSeconds)) {
      if (const auto* of_link = std::get_if<LinkFault>(&due)) {
        replies.link_faults.push_back(*of_link);
        if (of_link->kind == Fault::kCloseSocket) lose_link();
      } else if (const auto* act = std::get_if<Act>(&due)) {
        if (*act == Act::kJogHome && running()) perform(plant_, state_.cabinet, Act::kManualMode);
        perform(plant_, state_.cabinet, *act);
      } else {
        const Trouble& trouble = std::get<Trouble>(due);
        if (trouble.kind == TroubleKind::kRestarts && state_.connected) {
          fault(cs8::FaultCode::kStopping, 0);
        }
        apply(trouble, state_);
      }
    }
  }

  void watch_permission() {
    Cabinet& cabinet = state_.cabinet;
    if (cabinet.probe_disagrees()) tell(withdraw(state_.permit, PermitReason::kProbeFault));
    if (!motion_permitted(cabinet.panel)) {
      const bool collided = running() && running()->outcome == Outcome::kCollision;
      tell(withdraw(state_.permit, collided ? PermitReason::kBrokenOff : PermitReason::kPermissionLost));
      if (running()) break_off(cabinet, *running(), Outcome::kPermissionLost);
    }
    if (cabinet.task_error != 0) {  // the supervisor's
      if (running()) break_off(cabinet, *running(), Outcome::kTaskFailed, cabinet.task_error);
      tell(withdraw(state_.permit, PermitReason::kBrokenOff));
    }
  }

  // ---- ends ----

  void finish() {
    const RunningCommand ended = *std::exchange(running(), std::nullopt);
    const bool retract_due = !state_.motion.retract_path.empty();
    if (ended.outcome == Outcome::kCollision) replies.warning = ended.collision;
    state_.operator_called =
        ended.outcome == Outcome::kCollision ||
        (ended.outcome == Outcome::kUnexpectedContact && !retract_due && !state_.cabinet.probe_free());
    state_.stored_result = result(state_, ended);
    if (state_.greeted) replies.messages.push_back(*state_.stored_result);
    const bool may_retract = motion_permitted(state_.cabinet.panel) && state_.cabinet.task_error == 0;
    tell(after_command(state_.permit, ended.outcome, retract_due && may_retract));
  }

  void lose_link() {
    state_.connected = false;
    state_.greeted = false;
    end_permit_of_link();
  }

  void end_permit_of_link() {
    state_.permit = {};
    if (running()) break_off(state_.cabinet, *running(), Outcome::kHeartbeatLost);
  }

  void fault(cs8::FaultCode code, std::int32_t detail) {
    lose_link();
    send(0, cs8::Fault{code, detail});
    replies.close = true;
  }

  // ---- what is told ----

  void tell(const std::optional<cs8::Permit>& changed) {
    if (changed && state_.greeted) send(0, *changed);
  }

  void send(std::uint32_t sequence, const cs8::Payload& payload) {
    replies.messages.push_back({sequence, payload});
  }

  void report_state() {
    if (!state_.greeted || now_ < state_.next_state) return;
    send(++state_.state_counter, state_report(state_, now_));
    state_.next_state = now_ + kStatePeriod;
  }

  const Plant& plant_;
  ControllerState& state_;
  TimePoint now_;
  bool looked_at_ = false;  // a first tick sees what was changed from outside
};

}  // namespace

ControllerState make_controller(const Plant& plant, const ControllerOptions& options, TimePoint now) {
  ControllerState state;
  state.speed = options.speed;
  state.next_tick = now;
  state.cabinet = make_cabinet(plant, options.seed);
  state.person.duties = options.duties;
  start(state.person);
  state.session = options.session;
  state.heartbeat_timeout_max = options.heartbeat_timeout_max;
  return state;
}

Replies step(const Plant& plant, ControllerState& state, const Event& event, TimePoint now) {
  Step step(plant, state, now);
  std::visit(step, event);
  return std::move(step.replies);
}

}  // namespace sim
