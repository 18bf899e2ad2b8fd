// Hours of a badly run cell in short: whatever host and people do, the arm moves with a permit only, stops at
// the face, and no task ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cs8_protocol/names.hpp"
#include "tests/val3/bench.hpp"

namespace val3 {
namespace {

using namespace cs8;

std::string what_of(const Message& message) {
  if (const auto* permit = std::get_if<Permit>(&message.payload))
    return ' ' + std::string(name(permit->state));
  if (const auto* result = std::get_if<TouchResult>(&message.payload))
    return ' ' + std::string(name(result->outcome));
  if (const auto* rejected = std::get_if<Rejected>(&message.payload))
    return ' ' + std::string(name(rejected->reason));
  return "";
}

class BadDay {
 public:
  explicit BadDay(std::uint32_t seed) : chance_(seed) { bench.make_ready(); }

  void run(double seconds) {
    const double end_s = bench.cabinet.now_s + seconds;
    while (bench.cabinet.now_s < end_s && !testing::Test::HasFailure()) {
      somebody_acts();
      for (int left = draw(60) * (draw(3) == 0 ? 25 : 1); left > 0 && !testing::Test::HasFailure(); --left)
        tick();
    }
  }

  Bench bench;
  int accepted = 0;
  int contacts = 0;

 private:
  std::uint32_t draw(std::uint32_t below) { return static_cast<std::uint32_t>(chance_() % below); }

  /// What was sent and done, newest last: for whoever looks into a failure.
  void note(const std::string& what) {
    notes_.push_back(std::to_string(bench.cabinet.now_s) + ' ' + what);
    if (notes_.size() > 30) notes_.erase(notes_.begin());
  }
  std::string notes() const {
    std::string all;
    for (const std::string& line : notes_) all += line + '\n';
    return all + bench.log();
  }

  void tick() {
    const Joint before = bench.cabinet.joints_deg;
    const double depth_before_mm = bench.depth_mm();
    const auto message = bench.next(0.004);
    if (message) {
      note("got " + std::string(name(cs8::type_of(*message))) + what_of(*message));
      accepted += std::holds_alternative<Accepted>(message->payload) ? 1 : 0;
      if (const auto* result = std::get_if<TouchResult>(&message->payload)) {
        contacts += result->outcome == Outcome::kContact ? 1 : 0;
        open_ = message->sequence;
      }
      if (std::holds_alternative<MoveResult>(message->payload)) open_ = message->sequence;
    }
    const double now_s = bench.cabinet.now_s;
    if (bench.permit() != PermitState::kNone) permitted_s_ = now_s;
    // a search that was stopped goes back to approach by itself
    const bool back_from_search = depth_before_mm > -0.01 && bench.depth_mm() < depth_before_mm;
    if (bench.cabinet.joints_deg != before && !back_from_search) {
      EXPECT_LE(now_s - permitted_s_, 0.2) << "the arm moves without a permit\n" << notes();
    }
    if (bench.face_mm) {
      EXPECT_LT(bench.depth_mm(), *bench.face_mm + 1.0) << "the arm presses on\n" << notes();
    }
    for (const std::string& task : bench.controller.tasks())
      EXPECT_EQ(bench.controller.machine().task_status(task), 1) << task << '\n' << notes();
  }

  void send(std::uint32_t sequence, const Payload& payload) {
    if (!bench.connected()) return;
    note("send " + std::string(name(cs8::type_of(Message{sequence, payload}))));
    bench.send(sequence, payload);
  }

  void somebody_acts() {
    const std::uint32_t what = draw(100);
    if (what < 65)
      the_host(draw(16));
    else if (what < 78)
      a_person(draw(9));
    else
      all_well(draw(3));
  }

  void the_host(std::uint32_t what) {
    if (!bench.connected()) {
      if (bench.connect()) send(0, Hello{500});
      return;
    }
    Touch touch = bench.touch();
    touch.second_speed_um_s = draw(2) == 0 ? 0 : 2000;
    touch.second_backoff_dmm = 5000 + static_cast<std::int32_t>(draw(45001));
    switch (what) {
      case 0:
      case 1:
      case 2:
      case 3:
        return send(++sequence_, touch);
      case 4:
        return send(draw(sequence_ + 2), touch);
      case 5:
        return send(++sequence_, bench.travel_to(-20 - static_cast<double>(draw(60))));
      case 6:
        return send(++sequence_, Retract{20000, 30000});
      case 7:
        return send(0, Stop{});
      case 8:
        return send(0, ResultQuery{draw(sequence_ + 1)});
      case 9:
      case 10:
      case 11:
        return send(0, ResultAcknowledge{open_});
      case 12:
        return send(0, Begin{.run = 1, .confirm_within_ms = 5000});
      case 13:
        return draw(4) == 0 ? send(0, Finish{}) : void();
      case 14:
        return draw(4) == 0 ? bench.disconnect() : void();
      default:
        break;
    }
    if (draw(4) != 0) return;
    std::vector<std::uint8_t> bytes = encode({++sequence_, touch});
    bytes[draw(static_cast<std::uint32_t>(bytes.size()))] ^= static_cast<std::uint8_t>(1u << draw(8));
    bench.send_bytes(bytes);
  }

  void a_person(std::uint32_t what) {
    note("person " + std::to_string(what));
    switch (what) {
      case 0:
        bench.cell_closed = false;
        break;
      case 1:
        bench.cabinet.mode = static_cast<int>(draw(5));
        break;
      case 2:
        bench.cabinet.powered = false;
        break;
      case 3:
        bench.cabinet.held = true;
        break;
      case 4:
        bench.cabinet.es_status = static_cast<int>(draw(3));
        break;
      case 5:
        bench.wires.hand = draw(2) == 0;
        break;
      case 6:
        bench.wires.contact = draw(2) == 0;
        break;
      case 7:
        bench.wires.loop = draw(2) == 0;
        break;
      default:
        bench.confirm_key = !bench.confirm_key;
        break;
    }
    if (bench.wires.contact && bench.wires.loop) bench.wires.loop.reset();  // one wire at a time
  }

  /// Somebody puts all in order, makes the touch test and confirms what is asked.
  void all_well(std::uint32_t what) {
    if (what == 0 && bench.depth_mm() < -1)
      bench.face_mm = draw(3) == 0 ? std::optional<double>() : 2.0 + draw(16);
    if (what != 1) return;
    bench.cabinet.powered = true;
    bench.cabinet.held = false;
    bench.cabinet.es_status = 0;
    bench.wires = {};
    bench.cell_closed = true;
    bench.cabinet.mode = 1;
    for (const bool hand : {false, true, false}) {
      bench.wires.hand = hand;
      for (int i = 0; i < 10; ++i) tick();
    }
    bench.cabinet.mode = 4;
    for (int i = 0; i < 5; ++i) tick();
    send(0, ResultAcknowledge{open_});
    send(0, Begin{.run = 1, .confirm_within_ms = 5000});
    for (const bool key : {false, true, false}) {
      bench.confirm_key = key;
      for (int i = 0; i < 10; ++i) tick();
    }
    send(++sequence_, Retract{20000, 30000});
    for (int i = 0; i < 400; ++i) tick();
    send(0, ResultAcknowledge{open_});
    send(++sequence_, bench.touch());
  }

  std::mt19937 chance_;
  std::vector<std::string> notes_;
  std::uint32_t sequence_ = 0;
  std::uint32_t open_ = 0;
  double permitted_s_ = 0;
};

TEST(ApplicationChance, WhateverHappensTheArmIsSafeAndTheTasksLive) {
  int accepted = 0;
  int contacts = 0;
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    BadDay day(seed);
    day.run(100);
    accepted += day.accepted;
    contacts += day.contacts;
    if (testing::Test::HasFailure()) break;
  }
  EXPECT_GT(accepted, 20) << "too few commands were taken to mean anything";
  EXPECT_GT(contacts, 0);
  RecordProperty("accepted", accepted);
  RecordProperty("contacts", contacts);
}

}  // namespace
}  // namespace val3
