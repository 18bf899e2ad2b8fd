#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <vector>

#include "aimed_touch.hpp"
#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/controller.hpp"

namespace sim::testing {

using std::chrono::milliseconds;

inline cs8::Touch touch_command(const TouchMotion& motion) {
  cs8::Touch command;
  command.via_count = static_cast<std::int32_t>(motion.waypoints.size()) - 1;
  for (std::size_t i = 0; i + 1 < motion.waypoints.size(); ++i)
    command.via.at(i) = wire_from_joints(motion.waypoints[i]);
  command.clear = wire_from_joints(motion.waypoints.back());
  command.approach = wire_from_joints(motion.approach);
  command.search_end = wire_from_joints(motion.search_end);
  command.travel_speed_um_s = cs8::um_s_from_metres_per_second(motion.travel_speed_m_s);
  command.approach_speed_um_s = cs8::um_s_from_metres_per_second(motion.approach_speed_m_s);
  command.search_speed_um_s = cs8::um_s_from_metres_per_second(motion.search_speed_m_s);
  command.deadline_ms = 120'000;
  return command;
}

inline cs8::Travel travel_command(const calib::JointVector& target) {
  cs8::Travel command;
  command.target = wire_from_joints(target);
  command.travel_speed_um_s = 250'000;
  command.deadline_ms = 120'000;
  return command;
}

inline constexpr cs8::Retract kRetract{.approach_speed_um_s = 20'000, .deadline_ms = 120'000};

/// A controller and a host's hand on it, with made-up time.
class Bench {
 public:
  explicit Bench(Plant on_plant, ControllerOptions options = {})
      : plant(std::move(on_plant)), state(make_controller(plant, options, now)) {}

  /// Connected and greeted; the probe was touched by hand, the run is confirmed.
  static Bench ready(Plant plant, ControllerOptions options = {}) {
    Bench bench(std::move(plant), options);
    bench.connect();
    bench.permit();
    return bench;
  }

  /// Asks for a run until it is confirmed.
  void permit() {
    const auto granted = [this] { return state.permit.permit.state == cs8::PermitState::kGranted; };
    for (int i = 0; i < 100 && !granted(); ++i) {
      while (!state.cabinet.panel.powered) pass(milliseconds(20));
      send(0, cs8::Begin{.run = 1, .confirm_within_ms = 30'000});
      do {
        pass(milliseconds(20));
      } while (!granted() && !state.person.plan.empty());
    }
    if (!granted()) throw std::logic_error("the run is not confirmed");
  }

  std::vector<cs8::Message> happen(const Event& event) {
    last = step(plant, state, event, now);
    for (const cs8::Message& message : last.messages) sent.push_back(message);
    return last.messages;
  }

  std::vector<cs8::Message> send(std::uint32_t sequence, cs8::Payload payload) {
    return happen(cs8::Message{sequence, std::move(payload)});
  }

  cs8::Welcome connect(std::uint32_t heartbeat_timeout_ms = 500) {
    happen(ConnectionOpened{});
    return std::get<cs8::Welcome>(send(0, cs8::Hello{heartbeat_timeout_ms}).front().payload);
  }

  void tick(milliseconds duration) {
    now += duration;
    happen(Tick{});
  }

  /// Time passes with a host that sends its heartbeats.
  void pass(milliseconds duration) {
    for (milliseconds left = duration; left > milliseconds(0); left -= milliseconds(20)) {
      now += std::min(left, milliseconds(20));
      send(0, cs8::Heartbeat{});
      happen(Tick{});
    }
  }

  /// The answer to a motion command.
  template <class Answer>
  Answer answer(std::uint32_t sequence, cs8::Payload payload) {
    for (const cs8::Message& message : send(sequence, std::move(payload))) {
      if (message.sequence == sequence && std::holds_alternative<Answer>(message.payload)) {
        return std::get<Answer>(message.payload);
      }
    }
    throw std::logic_error("another answer");
  }

  cs8::RejectReason rejection(std::uint32_t sequence, cs8::Payload payload) {
    return answer<cs8::Rejected>(sequence, std::move(payload)).reason;
  }

  /// Lets time pass until the running command has its result.
  template <class Result>
  Result result() {
    for (int i = 0; i < 10'000 && state.motion.running; ++i) pass(milliseconds(20));
    return std::get<Result>(state.stored_result.value().payload);
  }

  /// Takes a touch into the given phase, or to its end for kIdle.
  void touch_until(std::uint32_t sequence, const TouchMotion& motion, cs8::Phase phase) {
    answer<cs8::Accepted>(sequence, touch_command(motion));
    while (state.motion.running && this->phase() != phase) pass(milliseconds(20));
  }

  cs8::Phase phase() const {
    const auto& running = state.motion.running;
    return running ? phase_of(running->stage) : cs8::Phase::kIdle;
  }
  const calib::JointVector& joints() const { return state.cabinet.drives.joints; }

  std::optional<cs8::State> last_state() const {
    for (auto message = sent.rbegin(); message != sent.rend(); ++message) {
      if (const auto* report = std::get_if<cs8::State>(&message->payload)) return *report;
    }
    return std::nullopt;
  }
  bool flag(cs8::StateFlag bit) const { return (last_state().value().flags & bit) != 0; }

  Plant plant;
  TimePoint now{std::chrono::hours(1)};
  ControllerState state;
  Replies last;
  std::vector<cs8::Message> sent;
};

/// Most tests make this touch on the top face of the cell `demo`, with its hidden truth.
class DemoTouch : public ::testing::Test {
 protected:
  static const cell::Cell& demo() {
    static const cell::Cell cell = read_cell("demo");
    return cell;
  }
  static const Plant& plant() {
    static const Plant plant = true_plant("demo");
    return plant;
  }
  static const AimedTouch& aimed() {
    static const AimedTouch touch = aimed_touch(demo(), {});
    return touch;
  }
  static const TouchMotion& motion() { return aimed().motion; }
  static cs8::Touch touch() { return touch_command(motion()); }
  static calib::JointVector beside_park() { return plant().start_joints + calib::JointVector::Constant(0.1); }
};

}  // namespace sim::testing
