#include "tests/sim_controller/bench.hpp"

#include <algorithm>
#include <stdexcept>

#include "cs8_protocol/wire_units.hpp"

namespace sim::testing {

cs8::Touch touch_command(const TouchMotion& motion) {
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

cs8::Travel travel_command(const calib::JointVector& target) {
  cs8::Travel command;
  command.target = wire_from_joints(target);
  command.travel_speed_um_s = 250'000;
  command.deadline_ms = 120'000;
  return command;
}

void Bench::permit() {
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

std::vector<cs8::Message> Bench::happen(const Event& event) {
  last = step(plant, state, event, now);
  for (const cs8::Message& message : last.messages) sent.push_back(message);
  return last.messages;
}

std::vector<cs8::Message> Bench::send(std::uint32_t sequence, cs8::Payload payload) {
  return happen(cs8::Message{sequence, std::move(payload)});
}

cs8::Welcome Bench::connect(std::uint32_t heartbeat_timeout_ms) {
  happen(ConnectionOpened{});
  return std::get<cs8::Welcome>(send(0, cs8::Hello{heartbeat_timeout_ms}).front().payload);
}

void Bench::tick(milliseconds duration) {
  now += duration;
  happen(Tick{});
}

void Bench::pass(milliseconds duration) {
  for (milliseconds left = duration; left > milliseconds(0); left -= milliseconds(20)) {
    now += std::min(left, milliseconds(20));
    send(0, cs8::Heartbeat{});
    happen(Tick{});
  }
}

void Bench::touch_until(std::uint32_t sequence, const TouchMotion& motion, cs8::Phase phase) {
  answer<cs8::Accepted>(sequence, touch_command(motion));
  while (state.motion.running && this->phase() != phase) pass(milliseconds(20));
}

cs8::Phase Bench::phase() const {
  const auto& running = state.motion.running;
  return running ? phase_of(running->stage) : cs8::Phase::kIdle;
}

std::optional<cs8::State> Bench::last_state() const {
  for (auto message = sent.rbegin(); message != sent.rend(); ++message) {
    if (const auto* report = std::get_if<cs8::State>(&message->payload)) return *report;
  }
  return std::nullopt;
}

const cell::Cell& DemoTouch::demo() {
  static const cell::Cell cell = read_cell("demo");
  return cell;
}

const Plant& DemoTouch::plant() {
  static const Plant plant = true_plant("demo");
  return plant;
}

const AimedTouch& DemoTouch::aimed() {
  static const AimedTouch touch = aimed_touch(demo(), {});
  return touch;
}

}  // namespace sim::testing
