#include "sim_controller/controller.hpp"

#include <algorithm>
#include <cmath>

#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/contact.hpp"
#include "sim_controller/reports.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::RejectReason;

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
    lose_link(now_);
  }

  void operator()(const Tick& tick) {
    if (tick.bytes_waiting) state_.last_heard = now_;
    advance();
  }

  void operator()(const cs8::Message& message) {
    state_.last_heard = now_;
    advance();
    const cs8::MessageType type = cs8::type_of(message);
    if (cs8::is_from_controller(type))
      return fault(cs8::FaultCode::kWrongSide, static_cast<std::int32_t>(type));
    if (!state_.greeted && type != cs8::MessageType::kHello) return fault(cs8::FaultCode::kNoHandshake, 0);
    std::visit([&](const auto& payload) { take(message.sequence, payload); }, message.payload);
  }

  Replies replies;

 private:
  // ---- messages ----

  void take(std::uint32_t, const cs8::Hello& hello) {
    state_.greeted = true;
    state_.heartbeat_timeout = std::clamp(std::chrono::milliseconds(hello.heartbeat_timeout_ms),
                                          kHeartbeatTimeoutMin, kHeartbeatTimeoutMax);
    state_.next_state = now_ + kStatePeriod;
    if (state_.operator_called) free_arm();
    send(0, welcome(plant_, state_, open_sequence(), now_));
  }

  void take(std::uint32_t, const cs8::Heartbeat&) {}

  void take(std::uint32_t sequence, const cs8::Touch& command) {
    if (!admit(sequence, command)) return;
    const double noise_m = plant_.touch_noise_m * gaussian(state_.chance);
    start(sequence, command, touch_timeline(plant_, state_.joints, touch_motion(command), noise_m));
    state_.running->search_speed_um_s = command.search_speed_um_s;
    state_.running->approach_speed_m_s = cs8::metres_per_second_from_um_s(command.approach_speed_um_s);
  }

  void take(std::uint32_t sequence, const cs8::Travel& command) {
    if (!admit(sequence, command)) return;
    const double speed_m_s = cs8::metres_per_second_from_um_s(command.travel_speed_um_s);
    start(sequence, command, travel_timeline(plant_, state_.joints, travel_waypoints(command), speed_m_s));
  }

  void take(std::uint32_t sequence, const cs8::Retract& command) {
    if (!admit(sequence, command)) return;
    const double speed_m_s = cs8::metres_per_second_from_um_s(command.approach_speed_um_s);
    start(sequence, command, retract_timeline(plant_, state_.way_out, speed_m_s));
  }

  void take(std::uint32_t, const cs8::Stop&) {
    if (!state_.running) return;
    RunningCommand& running = *state_.running;
    const Place place = here();
    if (place.phase != cs8::Phase::kSearch) return cut(now_, Outcome::kStopped);
    // Back to the approach posture first; the rest of the way out stays open to a Retract.
    std::vector<Stretch> way_out = way_out_from(running.timeline.legs, place.leg, place.share);
    Timeline back = retract_timeline(plant_, {way_out.front()}, running.approach_speed_m_s);
    back.outcome = Outcome::kStopped;
    back.phase = cs8::Phase::kSearch;
    back.way_out.assign(way_out.begin() + 1, way_out.end());
    running.timeline = std::move(back);
    running.started = now_;
    state_.joints = place.joints;
    finish_if_over();
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

  std::uint32_t open_sequence() const {
    if (state_.running) return state_.running->sequence;
    return state_.stored_result ? state_.stored_result->sequence : 0;
  }

  void repeat_answer() {
    if (state_.running) {
      send(state_.running->sequence, cs8::Accepted{});
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
    auto rejected = refusal_now(sequence, Command::kType);
    if (!rejected) rejected = refusal(plant_, command);
    if (!rejected && Command::kType != cs8::MessageType::kRetract &&
        trip_gap_m(plant_, state_.joints, 0.0) <= 0.0) {
      rejected = cs8::Rejected{RejectReason::kProbeTriggered, 0};
    }
    if (rejected) send(sequence, *rejected);
    return !rejected;
  }

  /// What the controller's present state has against a motion command.
  std::optional<cs8::Rejected> refusal_now(std::uint32_t sequence, cs8::MessageType type) const {
    const auto because = [](RejectReason reason, std::int32_t detail = 0) {
      return cs8::Rejected{reason, detail};
    };
    const Panel& panel = state_.panel;
    const bool is_retract = type == cs8::MessageType::kRetract;
    if (sequence <= state_.last_sequence) return because(RejectReason::kStaleSequence);
    if (state_.running) return because(RejectReason::kBusy);
    if (state_.stored_result) return because(RejectReason::kResultUnacknowledged);
    if (panel.emergency_stop != 0) return because(RejectReason::kEmergencyStop);
    if (panel.mode != cs8::WorkingMode::kRemote) return because(RejectReason::kNotRemote);
    if (!panel.powered) return because(RejectReason::kNotPowered);
    if (panel.held) return because(RejectReason::kHold);
    if (!panel.arm_calibrated) return because(RejectReason::kNotCalibrated);
    if (panel.monitor_speed_percent != 100) {
      return because(RejectReason::kMonitorSpeed, panel.monitor_speed_percent);
    }
    if (!state_.way_out.empty() && !is_retract) return because(RejectReason::kRetractPending);
    if (state_.way_out.empty() && is_retract) return because(RejectReason::kNothingToRetract);
    return std::nullopt;
  }

  template <class Command>
  void start(std::uint32_t sequence, const Command& command, Timeline timeline) {
    RunningCommand running;
    running.sequence = sequence;
    running.type = Command::kType;
    running.timeline = std::move(timeline);
    running.started = now_;
    running.deadline = now_ + std::chrono::milliseconds(command.deadline_ms);
    state_.running = std::move(running);
    state_.last_sequence = sequence;
    send(sequence, cs8::Accepted{});
  }

  // ---- time ----

  /// All that was due until now, in the order in which it was due.
  void advance() {
    if (state_.power_due && now_ >= *state_.power_due) {
      state_.panel.powered = true;
      state_.power_due.reset();
    }
    const TimePoint silent_at = state_.last_heard + state_.heartbeat_timeout;
    if (state_.running) {
      const bool deadline_first = !state_.connected || state_.running->deadline <= silent_at;
      const TimePoint cut_at = deadline_first ? state_.running->deadline : silent_at;
      if (end_of_running() <= std::min(now_, cut_at)) {
        finish();
      } else if (cut_at <= now_) {
        cut(cut_at, deadline_first ? Outcome::kDeadline : Outcome::kHeartbeatLost);
      } else if (!motion_permitted()) {
        cut(now_, Outcome::kPermissionLost);
      }
    }
    if (state_.connected && now_ >= silent_at) {
      lose_link(silent_at);
      replies.close = true;
    }
    if (state_.greeted && now_ >= state_.next_state) {
      send_state();
      state_.next_state = now_ + kStatePeriod;
    }
  }

  bool motion_permitted() const {
    const Panel& panel = state_.panel;
    return panel.powered && !panel.held && panel.emergency_stop == 0 &&
           panel.mode == cs8::WorkingMode::kRemote;
  }

  TimePoint end_of_running() const {
    const std::chrono::duration<double> wall(state_.running->timeline.duration_s() / state_.speed);
    return state_.running->started + std::chrono::ceil<TimePoint::duration>(wall);
  }

  /// Simulated time of a running command at a wall time before its end.
  double simulated_s(const RunningCommand& running, TimePoint at) const {
    return std::chrono::duration<double>(at - running.started).count() * state_.speed;
  }

  Place here() const {
    if (!state_.running) return {0, 1.0, cs8::Phase::kIdle, state_.joints};
    return place_at(state_.running->timeline, simulated_s(*state_.running, now_), state_.joints);
  }

  // ---- ends of motion ----

  void finish_if_over() {
    if (end_of_running() <= now_) finish();
  }

  /// The running command ends as its timeline says.
  void finish() {
    const RunningCommand running = *std::move(state_.running);
    const Timeline& timeline = running.timeline;
    state_.running.reset();
    state_.joints = place_at(timeline, timeline.duration_s(), state_.joints).joints;
    state_.way_out = timeline.way_out;
    if (timeline.outcome == Outcome::kCollision) {
      state_.panel.powered = false;
      replies.warning = timeline.collision;
    }
    const bool on_known_way = !state_.way_out.empty() || trip_gap_m(plant_, state_.joints, 0.0) > 0.0;
    state_.operator_called = timeline.outcome == Outcome::kCollision || !on_known_way;
    store_result(running, timeline.outcome, timeline.phase, timeline.capture);
  }

  /// The running command is ended by something else, and the arm stops where it is.
  void cut(TimePoint at, Outcome outcome) {
    const RunningCommand running = *std::move(state_.running);
    state_.running.reset();
    const Timeline& timeline = running.timeline;
    const double time_s = simulated_s(running, at);
    const Place place = place_at(timeline, time_s, state_.joints);
    state_.joints = place.joints;
    state_.way_out =
        timeline.legs.empty() ? std::vector<Stretch>{} : way_out_from(timeline.legs, place.leg, place.share);
    if (place.phase == cs8::Phase::kRetract) {  // one to the approach posture has the rest still before it
      state_.way_out.insert(state_.way_out.end(), timeline.way_out.begin(), timeline.way_out.end());
    }
    const bool captured = timeline.capture && timeline.capture->at_s <= time_s;
    store_result(running, outcome, place.phase, captured ? timeline.capture : std::nullopt);
  }

  void store_result(const RunningCommand& running, Outcome outcome, cs8::Phase phase,
                    const std::optional<Capture>& capture) {
    cs8::Message result{running.sequence, {}};
    if (running.type == cs8::MessageType::kTouch) {
      result.payload = touch_result(state_, running, {outcome, phase, capture});
    } else {
      result.payload = move_result(state_, running, {outcome, phase, capture});
    }
    state_.stored_result = result;
    if (state_.greeted) replies.messages.push_back(result);
  }

  void free_arm() {
    state_.operator_called = false;
    state_.joints = plant_.start_joints;
    state_.way_out.clear();
    state_.power_due = now_ + std::chrono::duration_cast<TimePoint::duration>(
                                  std::chrono::duration<double>(kPowerUpSeconds / state_.speed));
  }

  // ---- the connection ----

  void lose_link(TimePoint at) {
    state_.connected = false;
    state_.greeted = false;
    if (state_.running) cut(at, Outcome::kHeartbeatLost);
  }

  void fault(cs8::FaultCode code, std::int32_t detail) {
    lose_link(now_);
    send(0, cs8::Fault{code, detail});
    replies.close = true;
  }

  void send(std::uint32_t sequence, cs8::Payload payload) {
    replies.messages.push_back({sequence, std::move(payload)});
  }

  void send_state() { send(++state_.state_counter, state_report(plant_, state_, here(), now_)); }

  const Plant& plant_;
  ControllerState& state_;
  TimePoint now_;
};

}  // namespace

ControllerState make_controller(const Plant& plant, const ControllerOptions& options, TimePoint now) {
  ControllerState state;
  state.chance.seed(options.seed);
  state.speed = options.speed;
  state.session = options.session;
  state.joints = plant.start_joints;
  state.power_due = now + std::chrono::duration_cast<TimePoint::duration>(
                              std::chrono::duration<double>(kPowerUpSeconds / options.speed));
  return state;
}

Replies step(const Plant& plant, ControllerState& state, const Event& event, TimePoint now) {
  Step step(plant, state, now);
  std::visit(step, event);
  return std::move(step.replies);
}

}  // namespace sim
