#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "aimed_touch.hpp"
#include "cs8_protocol/codec.hpp"
#include "cs8_protocol/names.hpp"
#include "cs8_protocol/wire_units.hpp"
#include "sim_controller/admission.hpp"
#include "sim_controller/controller.hpp"

namespace sim::testing {

using std::chrono::milliseconds;

cs8::Touch touch_command(const TouchMotion& motion);

cs8::Travel travel_command(const calib::JointVector& target);

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
  void permit();

  std::vector<cs8::Message> happen(const Event& event);

  std::vector<cs8::Message> send(std::uint32_t sequence, cs8::Payload payload);

  cs8::Welcome connect(std::uint32_t heartbeat_timeout_ms = 500);

  void tick(milliseconds duration);

  /// Time passes with a host that sends its heartbeats.
  void pass(milliseconds duration);

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
  void touch_until(std::uint32_t sequence, const TouchMotion& motion, cs8::Phase phase);

  cs8::Phase phase() const;
  const calib::JointVector& joints() const { return state.cabinet.drives.joints; }

  std::optional<cs8::State> last_state() const;
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
  static const cell::Cell& demo();
  static const Plant& plant();
  static const AimedTouch& aimed();
  static const TouchMotion& motion() { return aimed().motion; }
  static cs8::Touch touch() { return touch_command(motion()); }
  static calib::JointVector beside_park() { return plant().start_joints + calib::JointVector::Constant(0.1); }
};

}  // namespace sim::testing
