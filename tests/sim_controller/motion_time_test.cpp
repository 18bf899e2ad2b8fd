// Predicted times against those that the simulated controller takes.
#include "calib_core/motion/motion_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <variant>

#include "calib_core/planning/touch_planning.hpp"
#include "config/identification_problem.hpp"
#include "tests/sim_controller/bench.hpp"

namespace sim {
namespace {

using testing::AimedTouch;
using testing::Bench;

/// What a plan may promise: of one touch with its way, and of many together.
constexpr double kOfOneTouch = 0.10;
constexpr double kOfAPlan = 0.05;

static_assert(calib::kToolAccelerationMetresPerSecond2 == kAccelerationMetresPerSecond2);
static_assert(calib::kJointRampSeconds == kJointRampSeconds);
static_assert(calib::kStopLatencySeconds == kStopLatencySeconds);
static_assert(calib::kSettlingSeconds - kSettledTicks * kTickSeconds < 1e-12 &&
              kSettledTicks * kTickSeconds - calib::kSettlingSeconds < 1e-12);

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
  /// Touches on each face of the cell that the arm reaches.
  static calib::TouchPlan planned(const calib::MotionLimits& limits) {
    constexpr int kPerFace = 7;
    calib::PlanningProblem problem{.nominal = demo().arm.model,
                                   .joint_ranges = demo().arm.joint_ranges,
                                   .faces = demo().block.faces,
                                   .stylus = demo().probe.stylus,
                                   .scene = demo().collision_scene(),
                                   .park_joints = demo().park_joints,
                                   .nominal_position_error_m = demo().nominal_position_error_m,
                                   .tilt_max_rad = demo().stylus_tilt_max_rad,
                                   .candidate_count = 1'000,
                                   .knowledge = cell::identification_problem(demo(), recipe()),
                                   .identification = recipe().identification,
                                   .workspace_box = demo().workspace_box,
                                   .motion = limits};
    problem.goal.criterion = calib::PlanCriterion::kInformation;
    for (const int face : recipe().faces) {
      problem.goal.fit_count += kPerFace;
      problem.requests.push_back(
          {.face = face, .fit_min = kPerFace, .fit_max = kPerFace, .held_out_count = 1});
    }
    return std::get<calib::TouchPlan>(calib::plan_touches(problem));
  }
  static const cell::Recipe& recipe() { return demo().recipes.at("edf-25"); }

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
      calib::JointVector turned = park;
      turned[joint] -= turn;
      for (const auto& [from, to] : {std::pair(park, turned), std::pair(turned, park)}) {
        bench.answer<cs8::Accepted>(++sequence, testing::travel_command(to));
        const double taken = taken_s(bench);
        EXPECT_EQ(bench.result<cs8::MoveResult>().outcome, cs8::Outcome::kArrived);
        bench.send(0, cs8::ResultAcknowledge{sequence});
        EXPECT_NEAR(calib::path_time_s(model(), limits(), std::array{from, to}), taken, 0.02 + 0.02 * taken)
            << "joint " << joint + 1 << " turned by " << turn;
      }
    }
  }
}

TEST_F(MotionTime, OfAPlanIsWhatTheControllerTakes) {
  const calib::TouchPlan plan = planned(limits());
  Bench bench = Bench::ready(testing::perfect_plant("demo"));
  std::uint32_t sequence = 0;
  double taken_sum_s = 0.0;
  for (const calib::PlannedTouch& touch : plan.touches) {
    TouchMotion motion{touch.via,           touch.approach_joints, touch.search_end_joints,
                       limits().travel_m_s, limits().approach_m_s, limits().search_m_s};
    motion.waypoints.push_back(touch.clear_joints);
    bench.answer<cs8::Accepted>(++sequence, command(motion, limits()));
    const double taken = taken_s(bench);
    ASSERT_EQ(bench.result<cs8::TouchResult>().outcome, cs8::Outcome::kContact) << "touch " << sequence;
    bench.send(0, cs8::ResultAcknowledge{sequence});
    EXPECT_NEAR(touch.travel_s + touch.touch_s, taken, kOfOneTouch * taken) << "touch " << sequence;
    taken_sum_s += taken;
  }
  cs8::Travel park = testing::travel_command(bench.plant.start_joints);
  park.via_count = static_cast<std::int32_t>(plan.park_via.size());
  std::ranges::transform(plan.park_via, park.via.begin(), wire_from_joints);
  bench.answer<cs8::Accepted>(++sequence, park);
  taken_sum_s += taken_s(bench);
  EXPECT_NEAR(plan.duration_s(), taken_sum_s, kOfAPlan * taken_sum_s);
  RecordProperty("predicted_s", std::to_string(plan.duration_s()));
  RecordProperty("taken_s", std::to_string(taken_sum_s));
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
