// Predicted times against those that the simulated controller takes.
#include "calib_core/motion_time.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/units.hpp"
#include "tests/sim_controller/bench.hpp"

namespace sim {
namespace {

using testing::Aim;
using testing::AimedTouch;
using testing::Bench;

/// What a plan may promise: of one touch with its way, and of many together.
constexpr double kOfOneTouch = 0.10;
constexpr double kOfAPlan = 0.05;

static_assert(calib::kToolAccelerationMetresPerSecond2 == kAccelerationMetresPerSecond2);
static_assert(calib::kJointRampSeconds == kJointRampSeconds);
static_assert(calib::kStopLatencySeconds == kStopLatencySeconds);

class MotionTime : public testing::DemoTouch {
 protected:
  static calib::MotionLimits limits() {
    return {.joint_speeds_max = demo().arm.joint_speeds_max,
            .travel_m_s = demo().speeds.travel_m_s,
            .approach_m_s = demo().speeds.approach_m_s,
            .search_m_s = demo().speeds.search_m_s,
            .second_m_s = demo().speeds.second.value().speed_m_s,
            .second_backoff_m = demo().speeds.second.value().backoff_m};
  }
  static const calib::PreparedModel& model() {
    static const calib::PreparedModel prepared = calib::prepare(demo().arm.model);
    return prepared;
  }
  static cs8::Touch command(const TouchMotion& motion, const calib::MotionLimits& limits) {
    cs8::Touch command = testing::touch_command(motion);
    command.second_speed_um_s = cs8::um_s_from_metres_per_second(limits.second_m_s);
    command.second_backoff_dmm = cs8::dmm_from_metres(limits.second_backoff_m);
    return command;
  }

  /// Simulated seconds until the command has its result; a tick at a time.
  static double taken_s(Bench& bench) {
    const TimePoint begin = bench.now;
    while (bench.state.motion.running) {
      bench.now += std::chrono::milliseconds(4);
      bench.send(0, cs8::Heartbeat{});
      bench.happen(Tick{});
    }
    return std::chrono::duration<double>(bench.now - begin).count();
  }

  static double search_contact_touch_s(const AimedTouch& aimed, const calib::MotionLimits& limits) {
    const auto contact = testing::search_contact(testing::perfect_plant("demo"), aimed.motion);
    return calib::touch_time_s(model(), limits,
                               {aimed.motion.waypoints.back(), aimed.motion.approach, contact.value()});
  }
};

TEST_F(MotionTime, OfTravelIsWhatTheControllerTakes) {
  Bench bench = Bench::ready(testing::perfect_plant("demo"));
  std::uint32_t sequence = 0;
  const calib::JointVector park = bench.plant.start_joints;
  for (const double turn : {0.02, 0.2, 0.6}) {
    for (int joint = 0; joint < calib::kJointCount; ++joint) {
      calib::JointVector target = park;
      target[joint] += turn;
      const calib::JointVector from = bench.joints();
      bench.answer<cs8::Accepted>(++sequence, testing::travel_command(target));
      const double taken = taken_s(bench);
      bench.send(0, cs8::ResultAcknowledge{sequence});
      EXPECT_NEAR(calib::way_time_s(model(), limits(), std::array{from, target}), taken, 0.02 + 0.02 * taken)
          << "joint " << joint + 1 << " turned by " << turn;
    }
  }
}

TEST_F(MotionTime, OfTouchesAndTheirWaysIsWhatTheControllerTakes) {
  Bench bench = Bench::ready(testing::perfect_plant("demo"));
  const calib::JointVector park = bench.plant.start_joints;
  std::uint32_t sequence = 0;
  double predicted_sum = 0.0, taken_sum = 0.0;
  calib::JointVector standing = park;
  for (const int face : {0, 1, 2, 3}) {
    for (const double tilt_deg : {5.0, 30.0}) {
      AimedTouch aimed =
          testing::aimed_touch(demo(), {.face = face, .tilt_rad = calib::radians_from_degrees(tilt_deg)});
      const calib::JointVector clear = aimed.motion.waypoints.back();
      aimed.motion.waypoints.insert(aimed.motion.waypoints.begin(), park);
      const double predicted = calib::way_time_s(model(), limits(), std::array{standing, park, clear}) +
                               search_contact_touch_s(aimed, limits());
      bench.answer<cs8::Accepted>(++sequence, command(aimed.motion, limits()));
      const double taken = taken_s(bench);
      ASSERT_EQ(bench.result<cs8::TouchResult>().outcome, cs8::Outcome::kContact) << face << ' ' << tilt_deg;
      bench.send(0, cs8::ResultAcknowledge{sequence});
      EXPECT_NEAR(predicted, taken, kOfOneTouch * taken) << "face " << face << " tilt " << tilt_deg;
      predicted_sum += predicted;
      taken_sum += taken;
      standing = clear;
    }
  }
  EXPECT_NEAR(predicted_sum, taken_sum, kOfAPlan * taken_sum);
  RecordProperty("predicted_s", std::to_string(predicted_sum));
  RecordProperty("taken_s", std::to_string(taken_sum));
}

TEST_F(MotionTime, OfATouchAloneIsWhatTheControllerTakesWithAndWithoutASecondTouch) {
  for (const double second_m_s : {0.0, 0.002, 0.004}) {
    calib::MotionLimits asked = limits();
    asked.second_m_s = second_m_s;
    Bench bench = Bench::ready(testing::perfect_plant("demo"));
    const calib::JointVector clear = motion().waypoints.back();
    bench.answer<cs8::Accepted>(1, testing::travel_command(clear));
    taken_s(bench);
    bench.send(0, cs8::ResultAcknowledge{1});
    bench.answer<cs8::Accepted>(2, command(motion(), asked));
    const double taken = taken_s(bench);
    ASSERT_EQ(bench.result<cs8::TouchResult>().outcome, cs8::Outcome::kContact);
    EXPECT_NEAR(search_contact_touch_s(aimed(), asked), taken, 0.02 * taken) << second_m_s;
  }
}

}  // namespace
}  // namespace sim
