#include <cstdlib>
#include <cstring>

#include "config/read_config.hpp"
#include "cs8_protocol/codec.hpp"
#include "sim_controller/controller.hpp"
#include "sim_controller/reports.hpp"

/// Arbitrary bytes as what happens to a controller: frames from a host, ticks, people at the panel, a probe
/// that fails. Nothing crashes or throws, what it says can be said, and nothing moves that nobody confirmed.
namespace {

using std::chrono::milliseconds;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}
  [[nodiscard]] bool empty() const { return rest_.empty(); }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  /// As many as there are; the rest is 0.
  std::vector<std::uint8_t> take(std::size_t count) {
    std::vector<std::uint8_t> taken(count);
    for (std::uint8_t& value : taken) value = byte();
    return taken;
  }

 private:
  std::span<const std::uint8_t> rest_;
};

const sim::Plant& plant() {
  static const sim::Plant plant = [] {
    const std::string folder = TOUCHCAL_SOURCE_DIR "/config/cells/demo/";
    return sim::make_plant(cell::read_cell(folder + "cell.json"),
                           cell::read_truth(folder + "truth-real.json"));
  }();
  return plant;
}

/// Two motion commands of three are near what the controller takes, so that some of them run.
void bring_near(cs8::Message& message, const sim::ControllerState& state, std::uint8_t how) {
  if (how % 3 == 0) return;
  message.sequence = state.last_sequence + 1;
  const cs8::JointsMicrodeg here = sim::state_report(state, {}).joints;
  const auto near = [&here, how](cs8::JointsMicrodeg& joints) {
    for (std::size_t i = 0; i < joints.size(); ++i)
      joints[i] = here[i] + joints[i] % (1'000'000 + how * 10'000);
  };
  if (auto* touch = std::get_if<cs8::Touch>(&message.payload)) {
    touch->via_count = 0;
    near(touch->clear);
    touch->approach = touch->clear;
    near(touch->search_end);
    touch->travel_speed_um_s = 250'000;
    touch->approach_speed_um_s = 20'000;
    touch->search_speed_um_s = 8'000;
    touch->second_speed_um_s = how % 2 == 0 ? 0 : 2'000;
    touch->second_backoff_dmm = 20'000;
    touch->deadline_ms = 1 + touch->deadline_ms % 60'000;
  } else if (auto* travel = std::get_if<cs8::Travel>(&message.payload)) {
    travel->via_count = 0;
    near(travel->target);
    travel->travel_speed_um_s = 250'000;
    travel->deadline_ms = 1 + travel->deadline_ms % 60'000;
  }
}

sim::Event next_event(Bytes& bytes, const sim::ControllerState& state) {
  const std::uint8_t kind = bytes.byte();
  // As the server has it: one connection at a time, and messages on it only.
  if (kind < 12 && !state.connected) return sim::ConnectionOpened{};
  if (kind < 12) return sim::ConnectionClosed{};
  if (kind < 100 || !state.connected) return sim::Tick{.bytes_waiting = kind % 2 == 0};
  const auto type = static_cast<cs8::MessageType>(1 + bytes.byte() % 11);
  const std::uint8_t how = bytes.byte();
  const cs8::Header header{type, bytes.byte(), static_cast<std::uint16_t>(cs8::payload_size(type))};
  auto decoded = cs8::decode(header, bytes.take(header.payload_length));
  if (auto* message = std::get_if<cs8::Message>(&decoded)) {
    bring_near(*message, state, how);
    return *message;
  }
  return sim::Tick{};
}

void meddle(Bytes& bytes, sim::ControllerState& state) {
  const std::uint8_t what = bytes.byte();
  if (what < 128) return;
  if (what < 200) return sim::perform(plant(), state.cabinet, static_cast<sim::Act>(what % 17));
  sim::ProbeTroubles& troubles = state.cabinet.world.probe.troubles;
  troubles.stylus = static_cast<sim::StylusTrouble>(what % 4);
  troubles.loop_wire = static_cast<sim::WireTrouble>(bytes.byte() % 3);
  troubles.bounces = what % 5;
  if (what > 250) state.cabinet.task_error = what;
}

void check(const sim::Replies& replies, const sim::ControllerState& before,
           const sim::ControllerState& after) {
  for (const cs8::Message& message : replies.messages) {
    const auto frame = cs8::encode(message);
    const auto header = cs8::decode_header(std::span(frame).first<cs8::kHeaderSize>());
    const auto again = cs8::decode(std::get<cs8::Header>(header), std::span(frame).subspan(cs8::kHeaderSize));
    if (!std::holds_alternative<cs8::Message>(again)) std::abort();
  }
  if (replies.messages.size() > 100) std::abort();
  const bool begun = after.last_sequence != before.last_sequence;
  // A key pressed in this very step lets a command through: it was awaited then.
  if (begun && before.permit.permit.state == cs8::PermitState::kNone) std::abort();
  if (!after.connected && after.permit.permit.state != cs8::PermitState::kNone) std::abort();
}

/// A run is confirmed already: what the bytes hold moves at once.
void confirm(sim::ControllerState& state, sim::TimePoint now) {
  state.person.plan.clear();
  state.cabinet.panel.powered = true;
  state.cabinet.touch_test = sim::TouchTest::kDone;
  sim::step(plant(), state, sim::ConnectionOpened{}, now);
  sim::step(plant(), state, cs8::Message{0, cs8::Hello{2000}}, now);
  state.permit.permit.state = cs8::PermitState::kGranted;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  sim::TimePoint now{std::chrono::hours(1)};
  const std::uint8_t start = bytes.byte();
  const double speed = start % 2 == 0 ? 20.0 : sim::kSpeedMax;
  sim::ControllerState state = sim::make_controller(plant(), {.seed = 1, .speed = speed}, now);
  if (start >= 64) confirm(state, now);
  for (int i = 0; i < 200 && !bytes.empty(); ++i) {
    now += milliseconds(bytes.byte() * 4);
    meddle(bytes, state);
    const sim::Event event = next_event(bytes, state);
    const sim::ControllerState before = state;
    check(sim::step(plant(), state, event, now), before, state);
  }
  return 0;
}
