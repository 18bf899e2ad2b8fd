#include <gtest/gtest.h>

#include "bench.hpp"
#include "sim_controller/controller.hpp"

namespace sim {
namespace {

using cs8::Outcome;
using cs8::Phase;
using cs8::RejectReason;
using testing::aimed_touch;
using testing::Bench;
using testing::kRetract;
using testing::milliseconds;
using testing::tip_m;
using testing::touch_command;
using testing::travel_command;

class Admission : public testing::DemoTouch {};

TEST_F(Admission, RefusesAPostureOutOfRangeAndNamesTheJoint) {
  Bench bench = Bench::ready(plant());
  for (std::size_t joint = 0; joint < 6; ++joint) {
    cs8::Travel travel = travel_command(plant().start_joints);
    travel.target[joint] = wire_from_joints(plant().joint_ranges.upper)[joint] + 1;
    const auto rejected = bench.answer<cs8::Rejected>(1, travel);
    EXPECT_EQ(rejected.reason, RejectReason::kOutOfRange);
    EXPECT_EQ(rejected.detail, static_cast<std::int32_t>(joint) + 1);
  }
  for (auto posture : {&cs8::Touch::clear, &cs8::Touch::approach, &cs8::Touch::search_end}) {
    cs8::Touch bad = touch();
    (bad.*posture)[2] = -180'000'000;
    EXPECT_EQ(bench.rejection(1, bad), RejectReason::kOutOfRange);
  }
  cs8::Touch bad_via = touch();
  bad_via.via_count = 1;
  bad_via.via[0][4] = 180'000'000;
  EXPECT_EQ(bench.rejection(1, bad_via), RejectReason::kOutOfRange);
  bad_via.via_count = 0;
  bench.answer<cs8::Accepted>(1, bad_via);
}

TEST_F(Admission, TakesAPostureExactlyOnItsLimit) {
  Plant free = plant();
  free.scene = {};
  Bench bench = Bench::ready(free);
  cs8::Travel travel = travel_command(plant().start_joints);
  travel.target = wire_from_joints(plant().joint_ranges.upper);
  bench.answer<cs8::Accepted>(1, travel);
}

TEST_F(Admission, RefusesASearchThatIsTooLong) {
  Bench bench = Bench::ready(plant());
  const auto longer =
      aimed_touch(demo(), {.standoff_m = 0.0385, .end_depth_m = kSearchLengthMaxMetres - 0.0384});
  const auto rejected = bench.answer<cs8::Rejected>(1, touch_command(longer.motion));
  EXPECT_EQ(rejected.reason, RejectReason::kSearchTooLong);
  EXPECT_EQ(rejected.detail, cs8::dmm_from_metres(kSearchLengthMaxMetres));
}

TEST_F(Admission, RefusesASearchThatCouldNotStopWithinHalfTheOvertravel) {
  Bench bench = Bench::ready(plant());
  cs8::Touch fast = touch();
  fast.search_speed_um_s = search_speed_max_um_s(plant()) + 1;
  const auto rejected = bench.answer<cs8::Rejected>(1, fast);
  EXPECT_EQ(rejected.reason, RejectReason::kSearchTooFast);
  EXPECT_EQ(rejected.detail, search_speed_max_um_s(plant()));
  fast.search_speed_um_s = rejected.detail;
  bench.answer<cs8::Accepted>(1, fast);
}

TEST_F(Admission, RefusesFieldsThatMakeNoSenseAndNamesTheWord) {
  Bench bench = Bench::ready(plant());
  const auto word = [&bench](const cs8::Payload& payload) {
    const auto rejected = bench.answer<cs8::Rejected>(1, payload);
    EXPECT_EQ(rejected.reason, RejectReason::kBadField);
    return rejected.detail;
  };
  const auto changed = [](auto command, auto field, auto value) {
    command.*field = value;
    return command;
  };
  // A payload of 55 words: via_count, 5 x 6, 3 x 6, three speeds, the second touch's two, the deadline.
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::via_count, 6)), 1);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::via_count, -1)), 1);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::search_end, touch().approach)), 44);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::travel_speed_um_s, 0)), 50);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::approach_speed_um_s, -1)), 51);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::search_speed_um_s, 0)), 52);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::travel_speed_um_s, 250'001)), 50);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::approach_speed_um_s, 20'001)), 51);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::second_speed_um_s, -1)), 53);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::second_speed_um_s, touch().search_speed_um_s + 1)), 53);
  cs8::Touch twice = touch();
  twice.second_speed_um_s = 2000;
  EXPECT_EQ(word(changed(twice, &cs8::Touch::second_backoff_dmm, 4'999)), 54);
  EXPECT_EQ(word(changed(twice, &cs8::Touch::second_backoff_dmm, 50'001)), 54);
  EXPECT_EQ(word(changed(touch(), &cs8::Touch::deadline_ms, 0u)), 55);
  const cs8::Travel travel = travel_command(beside_park());
  EXPECT_EQ(word(changed(travel, &cs8::Travel::travel_speed_um_s, 0)), 38);
  EXPECT_EQ(word(changed(travel, &cs8::Travel::deadline_ms, 0u)), 39);
  EXPECT_EQ(cs8::payload_size(cs8::MessageType::kTouch), 55u * 4u);
  EXPECT_EQ(cs8::payload_size(cs8::MessageType::kTravel), 39u * 4u);
}

TEST_F(Admission, RefusesWhatTheCabinetDoesNotPermit) {
  Bench bench = Bench::ready(plant());
  const auto rejection_with = [&bench](auto change) {
    const Panel before = bench.state.cabinet.panel;
    change(bench.state.cabinet.panel);
    const auto reason = bench.rejection(1, touch());
    bench.state.cabinet.panel = before;
    return reason;
  };
  EXPECT_EQ(rejection_with([](Panel& p) { p.mode = cs8::WorkingMode::kManual; }), RejectReason::kNotRemote);
  EXPECT_EQ(rejection_with([](Panel& p) { p.powered = false; }), RejectReason::kNotPowered);
  EXPECT_EQ(rejection_with([](Panel& p) { p.held = true; }), RejectReason::kHold);
  EXPECT_EQ(rejection_with([](Panel& p) { p.emergency_stop = 2; }), RejectReason::kEmergencyStop);
  EXPECT_EQ(rejection_with([](Panel& p) { p.arm_calibrated = false; }), RejectReason::kNotCalibrated);
  EXPECT_EQ(rejection_with([](Panel& p) { p.monitor_speed_percent = 50; }), RejectReason::kMonitorSpeed);
  bench.answer<cs8::Accepted>(1, touch());
}

TEST_F(Admission, RefusesToMoveWithATouchedProbe) {
  Bench bench = Bench::ready(plant());
  bench.state.cabinet.world.probe.troubles.stylus = StylusTrouble::kStaysTouched;
  bench.pass(milliseconds(20));
  EXPECT_EQ(bench.rejection(1, touch()), RejectReason::kProbeTriggered);
  EXPECT_TRUE(bench.flag(cs8::kProbeTouched));
}

TEST_F(Admission, RefusesToMoveWithProbeInputsThatDisagreeWhicheverWireIsAtFault) {
  const auto inputs = [](WireTrouble contact, WireTrouble loop) {
    Bench bench = Bench::ready(plant());
    bench.state.cabinet.world.probe.troubles.contact_wire = contact;
    bench.state.cabinet.world.probe.troubles.loop_wire = loop;
    bench.pass(milliseconds(4));
    return bench.answer<cs8::Rejected>(1, touch());
  };
  const cs8::Rejected cut = inputs(WireTrouble::kNone, WireTrouble::kCut);
  EXPECT_EQ(cut.reason, RejectReason::kProbeInputs);
  EXPECT_EQ(cut.detail, 0);
  const cs8::Rejected shorted = inputs(WireTrouble::kShorted, WireTrouble::kNone);
  EXPECT_EQ(shorted.reason, RejectReason::kProbeInputs);
  EXPECT_EQ(shorted.detail, 3);
}

TEST_F(Admission, RefusesARetractWithNothingToRetractFrom) {
  Bench bench = Bench::ready(plant());
  EXPECT_EQ(bench.rejection(1, kRetract), RejectReason::kNothingToRetract);
}

}  // namespace
}  // namespace sim
