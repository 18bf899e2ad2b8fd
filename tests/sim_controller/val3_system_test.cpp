// The simulated cell under a VAL3 application.
#include "sim_controller/val3_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim_controller/operator.hpp"
#include "sim_controller/val3_units.hpp"
#include "val3_cell.hpp"

namespace sim {
namespace {

using namespace testing;
using val3::MoveOrder;

TEST_F(Val3Cell, ClockGoesOnByTicksInMilliseconds) {
  const double before = system.clock_s();
  ticks(250);
  EXPECT_DOUBLE_EQ(system.clock_s() - before, 1.0);
}

TEST_F(Val3Cell, ABlendThatIsNotMadeIsToldOnceAndWhereThereIsOneOnly) {
  MoveOrder blended = joint_move(clear());
  blended.descriptor.blend = val3::Blend::kJoint;
  const MoveOrder back = joint_move(search().approach);
  EXPECT_EQ(system.store(back), val3::kErrorNone);
  EXPECT_EQ(system.store(blended), val3::kErrorNone);
  EXPECT_TRUE(system.messages().empty()) << "the last move has none to go over into";
  EXPECT_EQ(system.store(back), val3::kErrorNone);
  ASSERT_EQ(system.messages().size(), 1U);
  EXPECT_NE(system.messages().back().find("blends are not simulated"), std::string::npos);
  EXPECT_EQ(system.store(blended), val3::kErrorNone);
  EXPECT_EQ(system.store(back), val3::kErrorNone);
  EXPECT_EQ(system.messages().size(), 1U);
}

TEST_F(Val3Cell, ABlendedMoveThatHasEndedIsNone) {
  MoveOrder blended = joint_move(clear());
  blended.descriptor.blend = val3::Blend::kJoint;
  EXPECT_EQ(system.store(blended), val3::kErrorNone);
  until_empty();
  EXPECT_EQ(system.store(joint_move(search().approach)), val3::kErrorNone);
  EXPECT_TRUE(system.messages().empty());
}

TEST_F(Val3Cell, ALineOfTheProbeIsTheSearchOfTheTwin) {
  ASSERT_EQ(system.store(line_to(above_face())), val3::kErrorNone);
  EXPECT_FALSE(system.is_empty());
  double fastest = 0.0;
  for (int i = 0; i < kTicksMax && !system.is_empty(); ++i) {
    system.tick();
    EXPECT_LT(on_search_line(cabinet.drives.joints).off_m, 1e-6);
    fastest = std::max(fastest, system.tool_speed(kProbeTool));
  }
  EXPECT_NEAR(fastest, 20.0, 0.1);
  EXPECT_NEAR(on_search_line(cabinet.drives.joints).along_m, kFreeMetres, 1e-6);
  EXPECT_FALSE(system.is_settled());
  ticks(kSettledTicks);
  EXPECT_TRUE(system.is_settled());
}

TEST_F(Val3Cell, AJointMoveGoesThereAndCountsItsNumber) {
  EXPECT_EQ(system.move_id(), 0.0);
  ASSERT_EQ(system.store(joint_move(clear())), val3::kErrorNone);
  EXPECT_EQ(system.last_move_id(), 1.0);
  EXPECT_LT((joints_from_val3(system.last_stored()) - clear()).norm(), 1e-9);
  until_empty();
  EXPECT_LT((cabinet.drives.joints - clear()).norm(), 1e-9);
  EXPECT_EQ(system.move_id(), 2.0);
}

TEST_F(Val3Cell, AFollowingErrorIsThereWhileTheArmMoves) {
  EXPECT_EQ(system.position_error(), val3::Joint{});
  ASSERT_EQ(system.store(joint_move(clear())), val3::kErrorNone);
  ticks(10);
  EXPECT_NE(system.position_error(), val3::Joint{});
}

TEST_F(Val3Cell, AnImpossibleMoveIsToldWithTheNextOneUntilAReset) {
  calib::JointVector beyond = plant().start_joints;
  beyond[0] = plant().joint_ranges.upper[0] + 0.01;
  EXPECT_EQ(system.store(joint_move(beyond)), val3::kErrorNone);
  EXPECT_EQ(system.move_error(), val3::kErrorNone);
  ticks(2);
  EXPECT_EQ(system.move_error(), val3::kErrorImpossibleMove);
  EXPECT_EQ(system.store(joint_move(plant().start_joints)), val3::kErrorImpossibleMove);
  EXPECT_TRUE(system.is_empty());
  system.reset_motion(std::nullopt);
  EXPECT_EQ(system.store(joint_move(plant().start_joints)), val3::kErrorNone);
}

TEST_F(Val3Cell, ALineIntoAnotherConfigurationOrOutOfReachIsImpossible) {
  MoveOrder forced = line_to(search().search_end);
  forced.config = system.config_of(system.joints());
  forced.config.elbow =
      forced.config.elbow == val3::Elbow::kPositive ? val3::Elbow::kNegative : val3::Elbow::kPositive;
  MoveOrder unreachable = line_to(search().search_end);
  unreachable.reachable = false;
  MoveOrder far = line_to(search().search_end);
  far.to_pose.x += 3000.0;
  MoveOrder no_circle = line_to(search().search_end);
  no_circle.shape = MoveOrder::Shape::kCircle;
  no_circle.via_pose = no_circle.to_pose;
  for (const MoveOrder& order : {forced, unreachable, far, no_circle}) {
    system.reset_motion(std::nullopt);
    EXPECT_EQ(system.store(order), val3::kErrorNone);
    ticks(2);
    EXPECT_EQ(system.move_error(), val3::kErrorImpossibleMove);
  }
}

TEST_F(Val3Cell, TheStoreIsFullAtItsSize) {
  while (!system.store_is_full()) ASSERT_EQ(system.store(joint_move(search().approach)), val3::kErrorNone);
  EXPECT_EQ(cabinet.drives.queue.size(), Val3SystemOptions{}.moves_max);
}

TEST_F(Val3Cell, TheLatchHasTheJointsOfTheEdgeAndKeepsThemUntilItIsArmedAgain) {
  const int contact = system.find_digital("FastIO\\fIn0").value();
  EXPECT_FALSE(system.latched());
  ASSERT_EQ(system.arm_latch(contact), val3::kErrorNone);
  ASSERT_EQ(system.store(line_to(search().search_end)), val3::kErrorNone);
  for (int i = 0; i < kTicksMax && !system.digital(contact); ++i) {
    EXPECT_FALSE(system.latched());
    system.tick();
  }
  const auto latched = system.latched();
  ASSERT_TRUE(latched);
  const auto expected = search_contact(plant(), search(), cabinet.world.noise_m);
  ASSERT_TRUE(expected);
  // 0.2 ms at 20 mm/s, and the play of a sharp latch step.
  EXPECT_LT(tip_distance_m(plant(), joints_from_val3(*latched), *expected), 8e-6);
  system.reset_motion(std::nullopt);
  ticks(100);
  EXPECT_EQ(system.latched(), latched);
  ASSERT_EQ(system.arm_latch(contact), val3::kErrorNone);
  EXPECT_FALSE(system.latched());
}

TEST_F(Val3Cell, OnlyFastInputsHaveALatchAndAScriptCanTripOne) {
  EXPECT_EQ(system.arm_latch(system.find_digital("BasicIO-1\\%I0").value()), val3::kErrorParameter);
  const int other = system.find_digital("fIn1").value();
  ASSERT_EQ(system.arm_latch(other), val3::kErrorNone);
  ticks(2);
  EXPECT_FALSE(system.latched());
  ASSERT_TRUE(system.signals().set("FastIO\\fIn1", true));
  ticks(1);
  EXPECT_TRUE(system.latched());
}

TEST_F(Val3Cell, AnImpossibleMoveGoesToTheMessagesWhenItsTurnComes) {
  ASSERT_EQ(system.store(line_to(above_face())), val3::kErrorNone);
  val3::MoveOrder order{.shape = val3::MoveOrder::Shape::kJoint, .to = {0, 0, 150, 0, 0, 0}};
  order.origin = {"main~", "start.pgx", 4};
  ASSERT_EQ(system.store(order), val3::kErrorNone);
  ticks(1);
  EXPECT_TRUE(system.messages().empty()) << "the line comes first";
  until_empty();
  ticks(1);
  ASSERT_EQ(system.messages().size(), 1u);
  EXPECT_TRUE(system.messages()[0].starts_with("error 150: movej at start.pgx:4 of task main~: joint 3 at "));
  EXPECT_FALSE(system.why_move_failed().empty());
  ticks(10);
  EXPECT_EQ(system.messages().size(), 1u) << "once";
  system.reset_motion({});
  EXPECT_EQ(system.why_move_failed(), "");
}

TEST_F(Val3Cell, TellsOnceThatMoreThanOneClientIsNotSimulated) {
  const int channel = system.find_channel("Socket\\host").value();
  EXPECT_EQ(system.set_channel(channel, "clients", 1.0, {}, nullptr), 0);
  EXPECT_TRUE(system.messages().empty());
  for (int i = 0; i < 2; ++i) EXPECT_EQ(system.set_channel(channel, "clients", 2.0, {}, nullptr), -3);
  ASSERT_EQ(system.messages().size(), 1u);
  EXPECT_EQ(system.messages()[0],
            "Socket\\host: sioCtrl gives -3 to more than one of clients: one is simulated");
}

TEST_F(Val3Cell, ModeStatusAndHoldAreNumberedByMode) {
  EXPECT_EQ(system.working_mode(), 4);
  EXPECT_EQ(system.mode_status(), 0);
  perform(plant(), cabinet, Act::kHold);
  EXPECT_EQ(system.mode_status(), 2);
  perform(plant(), cabinet, Act::kManualMode);
  EXPECT_EQ(system.working_mode(), 1);
  EXPECT_EQ(system.mode_status(), 6);
  perform(plant(), cabinet, Act::kEmergencyStop);
  EXPECT_EQ(system.emergency_stop(), 2);
  EXPECT_FALSE(system.is_powered());
}

TEST_F(Val3Cell, AProgramMovesInEachModeAsItsStatusSays) {
  using Mode = cs8::WorkingMode;
  const auto moves = [this](Mode mode, int status) {
    cabinet.panel.mode = mode;
    cabinet.panel.mode_status = status;
    const calib::JointVector before = cabinet.drives.joints;
    ticks(5);
    const bool moved = cabinet.drives.joints != before;
    cabinet.panel.mode = Mode::kNone;
    ticks(50);  // it comes to rest
    return moved;
  };
  calib::JointVector far = cabinet.drives.joints;
  far[5] += 1.0;
  ASSERT_EQ(system.store(joint_move(far)), val3::kErrorNone);
  for (const Mode mode : {Mode::kRemote, Mode::kLocal, Mode::kTest, Mode::kManual}) {
    EXPECT_TRUE(moves(mode, 0)) << static_cast<int>(mode);
    EXPECT_FALSE(moves(mode, 1)) << static_cast<int>(mode);
  }
  EXPECT_TRUE(moves(Mode::kTest, 2));
  EXPECT_FALSE(moves(Mode::kManual, 2)) << "a person jogs";
  EXPECT_FALSE(moves(Mode::kNone, 0));
  cabinet.panel.cell_closed = false;
  EXPECT_FALSE(moves(Mode::kLocal, 0));
  EXPECT_TRUE(moves(Mode::kManual, 0));
  perform(plant(), cabinet, Act::kHold);
  EXPECT_FALSE(moves(Mode::kManual, 0));
}

TEST_F(Val3Cell, InManualModeTheToolIsNoFasterThan250MillimetresASecond) {
  const auto fastest = [this](cs8::WorkingMode mode, int status, bool is_line) {
    cabinet.panel.mode = mode;
    cabinet.panel.mode_status = status;
    displace(cabinet.drives, search().approach);
    MoveOrder order = joint_move(clear());
    if (is_line) {
      order = line_to(clear());
      order.descriptor = {.blend = val3::Blend::kOff};
    }
    order.tool = kProbeTool;
    EXPECT_EQ(system.store(order), val3::kErrorNone);
    double speed = 0.0;
    for (int i = 0; i < kTicksMax && !system.is_empty(); ++i) {
      system.tick();
      speed = std::max(speed, system.tool_speed(kProbeTool));
    }
    EXPECT_TRUE(system.is_empty());
    return speed;
  };
  for (const bool is_line : {false, true}) {
    EXPECT_GT(fastest(cs8::WorkingMode::kLocal, 0, is_line), 260.0);
    EXPECT_GT(fastest(cs8::WorkingMode::kTest, 2, is_line), 260.0);
    for (const auto slow : {cs8::WorkingMode::kManual, cs8::WorkingMode::kTest}) {
      const double speed = fastest(slow, 0, is_line);
      EXPECT_LT(speed, 250.0 * (1.0 + kToolSpeedErrorMax));
      EXPECT_GT(speed, 50.0);
    }
  }
}

TEST_F(Val3Cell, PowerComesUpInRemoteModeOnlyAndTakesItsTime) {
  system.disable_power();
  EXPECT_FALSE(system.is_powered());
  cabinet.panel.mode = cs8::WorkingMode::kLocal;
  system.enable_power();
  ticks(2000);
  EXPECT_FALSE(system.is_powered());
  cabinet.panel.mode = cs8::WorkingMode::kRemote;
  system.enable_power();
  ticks(static_cast<int>(kPowerUpSeconds / kTickSeconds) - 1);
  EXPECT_FALSE(system.is_powered());
  ticks(1);
  EXPECT_TRUE(system.is_powered());
}

TEST_F(Val3Cell, PowerThatGoesInAMoveLeavesItStored) {
  ASSERT_EQ(system.store(line_to(above_face())), val3::kErrorNone);
  ticks(100);
  system.disable_power();
  ticks(200);
  EXPECT_FALSE(system.is_empty());
  EXPECT_GT(kFreeMetres - on_search_line(cabinet.drives.joints).along_m, 1e-3);
  cabinet.panel.powered = true;
  until_empty();
  EXPECT_NEAR(on_search_line(cabinet.drives.joints).along_m, kFreeMetres, 1e-6);
}

TEST_F(Val3Cell, ACollisionTakesThePowerAndLeavesTheMoveStored) {
  ASSERT_EQ(system.store(line_to(search().search_end)), val3::kErrorNone);
  for (int i = 0; i < kTicksMax && system.is_powered(); ++i) system.tick();
  EXPECT_FALSE(system.is_powered());
  EXPECT_FALSE(system.is_empty());
}

TEST_F(Val3Cell, MonitorSpeedBelongsToTheOperator) {
  EXPECT_EQ(system.monitor_speed(), 100.0);
  EXPECT_EQ(system.set_monitor_speed(50), -2);
  cabinet.panel.mode = cs8::WorkingMode::kLocal;
  EXPECT_EQ(system.set_monitor_speed(50), -1);
}

TEST_F(Val3Cell, SaysWhatItIs) {
  EXPECT_EQ(system.version("ArmType"), plant().arm_name + "-S1");
  EXPECT_EQ(system.version("ArmSN"), "SIMULATED-TX90-0001");
  EXPECT_TRUE(system.version("VAL3").starts_with("s7.7.2 "));
  EXPECT_EQ(system.version("compliance"), "");
}

TEST_F(Val3Cell, TheEndOfAnApplicationStopsTheArmAndClosesItsChannels) {
  const int channel = system.find_channel("Socket\\host").value();
  ASSERT_TRUE(system.channels().at(channel).accept());
  ASSERT_EQ(system.store(line_to(search().search_end)), val3::kErrorNone);
  ticks(50);
  system.end_application();
  EXPECT_TRUE(system.is_empty());
  EXPECT_FALSE(system.connect(channel));
}

TEST_F(Val3Cell, KeepsTheNewestMessages) {
  for (std::size_t i = 0; i < Val3System::kMessagesMax + 5; ++i) system.log(std::to_string(i));
  system.pop_up("last");
  EXPECT_EQ(system.messages().size(), Val3System::kMessagesMax);
  EXPECT_EQ(system.messages().back(), "last");
}

TEST(Val3Date, IsWrittenByItsFormat) {
  using namespace std::chrono;
  const sys_seconds at = sys_days(year(2026) / 3 / 9) + hours(15) + minutes(4) + seconds(5);
  EXPECT_EQ(date_text("%Y-%m-%d %H:%M:%S", at), "2026-03-09 15:04:05");
  EXPECT_EQ(date_text("%y %I %p %x %", at), "26 03 PM %x %");
  EXPECT_EQ(date_text("%I%p", sys_days(year(2026) / 3 / 9)), "12AM");
}

}  // namespace
}  // namespace sim
