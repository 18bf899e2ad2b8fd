#include "tests/val3/bench.hpp"

#include <cmath>

#include "cs8_protocol/names.hpp"

namespace val3 {
namespace {

const Joint kApproachDeg{0, 20, 100, 0, 60, 0};  // the tool points straight down

cs8::JointsMicrodeg microdeg(const Joint& deg) {
  cs8::JointsMicrodeg result{};
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::int32_t>(std::lround(deg[i] * 1e6));
  return result;
}

}  // namespace

std::filesystem::path project_path() {
  return std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "cs8_protocol/val3/touchcal/touchcal.pjx";
}

Bench::Bench(Hardware hardware)
    : controller(project_path(), cabinet, [this, &hardware] { set_up(hardware); }) {
  inputs_ = {&cabinet.inputs[link(kContact)], &cabinet.inputs[link(kLoop)], &cabinet.inputs[link(kClosed)],
             &cabinet.inputs[link(kConfirm)]};
  controller.machine().set_truth(kHasLatch, hardware.latch);
  socket_ = &cabinet.sockets[link(kSocket)];
  cabinet.joints_deg = kApproachDeg;
  z_of_approach_m_ = cabinet.arm.world_from_flange(kApproachDeg).translation().z();
  const cs8::JointsMicrodeg clear = at_depth(-20);
  for (std::size_t i = 0; i < clear.size(); ++i) cabinet.joints_deg[i] = clear[i] / 1e6;
  cabinet.world = [this](Cabinet&) { update_inputs(); };
  update_inputs();
  controller.machine().start();
  seconds(0.1);
}

void Bench::set_up(const Hardware& hardware) {
  for (const char* input : {kContact, kLoop, kClosed, kConfirm}) cabinet.inputs[link(input)];
  if (hardware.latch) cabinet.latch_inputs.insert(link(kContact));
  cabinet.now_s = hardware.clock_s;
  cabinet.looks_empty_at_first = true;
  if (hardware.differs) hardware.differs(cabinet);
}

void Bench::spoil_globals(const std::set<std::string>& kept) {
  Machine& machine = controller.machine();
  for (const Global& global : controller.application().globals) {
    const Declaration& declared = global.declared;
    if (declared.name.starts_with("k") || kept.contains(declared.name)) continue;
    for (std::size_t i = 0; i < declared.sizes.at(0); ++i) {
      if (declared.type.kind == Kind::kNum) machine.set_number(declared.name, 12345.5, i);
      if (declared.type.kind == Kind::kBool)
        machine.set_truth(declared.name, !machine.truth(declared.name, i), i);
      if (declared.type.kind == Kind::kString) machine.set_text(declared.name, "left from before", i);
      if (declared.type.kind == Kind::kJoint)
        machine.set_joint(declared.name, {200, 200, 200, 200, 200, 200}, i);
    }
  }
}

std::string Bench::link(const std::string& variable) const {
  const int global = controller.application().global_named(variable);
  if (global < 0) throw std::logic_error("the application has no " + variable);
  return controller.application().globals[static_cast<std::size_t>(global)].values.at(0).attributes.at(
      "link");
}

std::string Bench::log() const {
  std::string all;
  for (const std::string& line : cabinet.lines) all += line + '\n';
  return all;
}

void Bench::update_inputs() {
  const double depth = depth_mm();
  bool touched = wires.hand || (face_mm && depth >= *face_mm) || (wires.stuck && was_touched_);
  was_touched_ = touched;
  if (face_mm && wires.bounce_mm > 0) {
    const double behind = depth - *face_mm;
    if (behind > wires.bounce_mm && behind < 2 * wires.bounce_mm) touched = false;
  }
  *inputs_[0] = wires.contact.value_or(touched);
  *inputs_[1] = wires.loop.value_or(!touched);
  *inputs_[2] = cell_closed;
  *inputs_[3] = confirm_key;
}

void Bench::ticks(int count) {
  for (int i = 0; i < count; ++i) {
    if (heartbeats && connected() && ++ticks_ % 25 == 0)
      send(0, cs8::Heartbeat{static_cast<std::uint32_t>(ticks_)});
    controller.tick();
    read_frames();
  }
}

void Bench::read_frames() {
  const std::vector<std::uint8_t>& bytes = socket().to_host;
  while (bytes.size() - read_ >= cs8::kHeaderSize) {
    const std::span<const std::uint8_t> rest = std::span(bytes).subspan(read_);
    const auto header = cs8::decode_header(rest.first<cs8::kHeaderSize>());
    if (const auto* error = std::get_if<cs8::DecodeError>(&header)) {
      ADD_FAILURE() << "the application sent a bad header: " << error->text();
      read_ = bytes.size();
      return;
    }
    const auto& good = std::get<cs8::Header>(header);
    if (rest.size() < cs8::kHeaderSize + good.payload_length) return;
    const auto decoded = cs8::decode(good, rest.subspan(cs8::kHeaderSize, good.payload_length));
    read_ += cs8::kHeaderSize + good.payload_length;
    if (const auto* error = std::get_if<cs8::DecodeError>(&decoded)) {
      ADD_FAILURE() << "the application sent a bad payload: " << error->text();
      continue;
    }
    const auto& message = std::get<cs8::Message>(decoded);
    if (const auto* state = std::get_if<cs8::State>(&message.payload)) {
      state_ = *state;
      ++states_seen_;
    } else {
      if (const auto* permit = std::get_if<cs8::Permit>(&message.payload)) permit_ = permit->state;
      inbox_.push_back(message);
    }
  }
}

bool Bench::connect() {
  if (!socket().connect()) return false;
  read_ = 0;
  permit_ = cs8::PermitState::kNone;
  inbox_.clear();
  return true;
}

cs8::Welcome Bench::greet(std::uint32_t heartbeat_timeout_ms) {
  EXPECT_TRUE(connect());
  send(0, cs8::Hello{heartbeat_timeout_ms});
  return expect<cs8::Welcome>(0, 0.5);
}

cs8::Welcome Bench::greet_again() {
  send(0, cs8::Hello{500});
  return expect<cs8::Welcome>(0, 0.5);
}

void Bench::send(std::uint32_t sequence, const cs8::Payload& payload) {
  send_bytes(cs8::encode({sequence, payload}));
}

void Bench::send_bytes(const std::vector<std::uint8_t>& bytes) {
  if (!connected()) return;
  auto& queue = socket().to_controller;
  queue.insert(queue.end(), bytes.begin(), bytes.end());
}

std::optional<cs8::Message> Bench::next(double within_s) {
  for (int left = static_cast<int>(within_s / kTickSeconds + 0.5); inbox_.empty() && left > 0; --left)
    ticks(1);
  if (inbox_.empty()) return std::nullopt;
  cs8::Message message = inbox_.front();
  inbox_.pop_front();
  return message;
}

cs8::State Bench::state() {
  // the one that comes first may have been made before what just happened
  const int wanted = states_seen_ + 2;
  for (int left = 20; states_seen_ < wanted && left > 0; --left) ticks(1);
  EXPECT_GE(states_seen_, wanted) << "no State\n" << log();
  return state_.value_or(cs8::State{});
}

void Bench::expect_silence(double s) {
  const auto message = next(s);
  if (message) ADD_FAILURE() << "unexpected message of type " << static_cast<int>(cs8::type_of(*message));
}

void Bench::touch_by_hand() {
  const int mode = cabinet.mode;
  cabinet.mode = 1;
  seconds(0.1);
  wires.hand = true;
  seconds(0.1);
  wires.hand = false;
  seconds(0.1);
  cabinet.mode = mode;
  cell_closed = true;
  seconds(0.1);
}

void Bench::confirm() {
  confirm_key = true;
  seconds(0.1);
  confirm_key = false;
  seconds(0.04);
}

void Bench::make_ready() {
  if (!connected()) {
    touch_by_hand();
    greet();
  }
  send(0, cs8::Begin{.run = 1, .confirm_within_ms = 30000});
  EXPECT_EQ(expect<cs8::Permit>(0).state, cs8::PermitState::kAwaited) << log();
  confirm();
  EXPECT_EQ(expect<cs8::Permit>(0).state, cs8::PermitState::kGranted) << log();
}

cs8::JointsMicrodeg Bench::at_depth(double mm) const {
  Eigen::Isometry3d pose = cabinet.arm.world_from_flange(kApproachDeg);
  pose.translation().z() -= mm / 1000.0;
  const auto joints = cabinet.arm.solve(pose, kApproachDeg);
  if (!joints) throw std::logic_error("a depth out of reach");
  return microdeg(*joints);
}

double Bench::depth_mm() const {
  return (z_of_approach_m_ - cabinet.arm.world_from_flange(cabinet.joints_deg).translation().z()) * 1000.0;
}

cs8::Touch Bench::touch() const {
  return {.clear = at_depth(-20),
          .approach = at_depth(0),
          .search_end = at_depth(20),
          .travel_speed_um_s = 250000,
          .approach_speed_um_s = 20000,
          .search_speed_um_s = 8000,
          .second_speed_um_s = 0,
          .second_backoff_dmm = 0,
          .deadline_ms = 60000};
}

cs8::Travel Bench::travel_to(double depth_mm) const {
  return {.target = at_depth(depth_mm), .travel_speed_um_s = 250000, .deadline_ms = 60000};
}

}  // namespace val3
