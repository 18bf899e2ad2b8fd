#include "service/acquisition/manual_touching.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "calib_core/kinematics/kinematic_model.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/acquisition/owners_bench.hpp"

namespace cell {
namespace {

class ManualTouchingTest : public ::testing::Test, public OwnersBench {
 protected:
  ManualTouchingTest() {
    active_.guided = true;
    touches_.begin_run(active_);
    status.enter(State::kExecute);
    wake.on_wait = {};
    run(manual_.await_touch(active_));
  }
  /// A person jogs the arm there: first free of it, `before_rad` off, then against it.
  void touch(const calib::JointVector& joints, double before_rad = 1e-5) {
    cs8::State state = ScriptedController::ready_state();
    state.joints = to_wire((joints.array() + before_rad).matrix());
    manual_.on_controller_state(&active_, state);
    state.flags = (state.flags | cs8::kProbeTouched) & ~static_cast<std::uint32_t>(cs8::kProbeLoopClosed);
    state.joints = to_wire(joints);
    manual_.on_controller_state(&active_, state);
    run(manual_.await_touch(active_));  // what was touched is stored
  }
  std::string problem() { return manual_.guide(status.state()).value().problem.value_or(""); }
  /// Where the first touch is asked for.
  calib::JointVector asked_for() { return manual_.guide(status.state()).value().about_joints.value(); }

  ActiveRun active_ = planned_run();
  TouchExecutor touches_{cell_of_owners(), computation, queue, session,      preparation,
                         block_move,       status,      wake,  time.clocks()};
  ManualTouching manual_{cell_of_owners(), queue, preparation, touches_, status, wake};
};

TEST_F(ManualTouchingTest, SaysWhichTouchComesNextAndKeepsTheOneThatIsMade) {
  const HandGuide guide = manual_.guide(status.state()).value();
  EXPECT_EQ(guide.activity, HandActivity::kGuided);
  EXPECT_EQ(guide.index, 1);
  EXPECT_EQ(guide.plane, plan_of_owners().touches.touches[0].face + 1);
  touch(asked_for());
  EXPECT_EQ(active_.run.touches_done(), 1) << problem();
  EXPECT_EQ(store.touches(active_.run.id()).size(), 1u);
  EXPECT_TRUE(controller.asked.empty()) << "nothing is commanded";
  run(manual_.await_touch(active_));  // the result with it
  run(manual_.await_touch(active_));
  EXPECT_EQ(manual_.guide(status.state()).value().index, 2);
}

// The ball moves by some 0.1 mm between the states: the touch weighs less than one that was latched.
TEST_F(ManualTouchingTest, ATouchHasTheNoiseOfTheWayOnWhichTheProbeTripped) {
  const calib::JointVector joints = asked_for();
  constexpr double kBeforeRad = 5e-5;
  const auto ball_m = [](const calib::JointVector& at) -> Eigen::Vector3d {
    return calib::forward_kinematics(cell_of_owners().arm.model, from_wire(to_wire(at))).translation();
  };
  const double moved_m = (ball_m(joints) - ball_m((joints.array() + kBeforeRad).matrix())).norm();
  ASSERT_GT(moved_m, 2e-5);
  touch(joints, kBeforeRad);
  ASSERT_EQ(active_.run.touches_done(), 1) << problem();
  const double declared_m = active_.run.problem().touch_noise_m;
  const double expected_um = 1e6 * std::hypot(declared_m, moved_m / std::sqrt(3.0));
  EXPECT_NEAR(store.touches(active_.run.id()).at(0).noise_um.value(), expected_um, 0.051);
  EXPECT_NEAR(1e6 * active_.run.problem().touches.at(0).deviation_m, expected_um, 0.051);
}

TEST_F(ManualTouchingTest, ABallThatComesTooFastDoesNotCount) {
  touch(asked_for(), 0.01);
  EXPECT_EQ(active_.run.touches_done(), 0);
  EXPECT_NE(problem().find("approach more slowly"), std::string::npos);
}

TEST_F(ManualTouchingTest, ATouchOfAnotherFaceDoesNotCount) {
  for (const calib::PlannedTouch& planned : plan_of_owners().touches.touches) {
    if (planned.face == active_.run.next()->face) continue;
    touch(planned.joints);
    break;
  }
  EXPECT_EQ(active_.run.touches_done(), 0);
  EXPECT_NE(problem().find("touch that one"), std::string::npos) << problem();
}

TEST_F(ManualTouchingTest, ATouchThatIsTakenBackIsAskedForAgain) {
  const calib::JointVector first = asked_for();
  touch(first);
  run(manual_.await_touch(active_));
  manual_.undo(active_);
  run(manual_.await_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 0);
  EXPECT_TRUE(store.touches(active_.run.id()).empty());
  EXPECT_EQ(preparation.aim().touch_count(), 0u);
  run(manual_.await_touch(active_));
  EXPECT_EQ(asked_for(), first);
}

TEST_F(ManualTouchingTest, TwoTouchesThatAreTakenBackAtOnceAreTwo) {
  for (int made = 0; made < 3; ++made) {
    touch(active_.run.next()->joints);
    run(manual_.await_touch(active_));
  }
  ASSERT_EQ(active_.run.touches_done(), 3) << problem();
  manual_.undo(active_);
  manual_.undo(active_);
  for (int step = 0; step < 3; ++step) run(manual_.await_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 1);
  EXPECT_EQ(store.touches(active_.run.id()).size(), 1u);
}

TEST_F(ManualTouchingTest, ATouchThatIsNotStoredYetIsTakenBackLikeAnyOther) {
  const calib::JointVector first = asked_for();
  cs8::State state = ScriptedController::ready_state();
  state.joints = to_wire((first.array() + 1e-5).matrix());
  manual_.on_controller_state(&active_, state);
  state.flags = (state.flags | cs8::kProbeTouched) & ~static_cast<std::uint32_t>(cs8::kProbeLoopClosed);
  state.joints = to_wire(first);
  manual_.on_controller_state(&active_, state);
  manual_.undo(active_);
  run(manual_.await_touch(active_));
  EXPECT_EQ(active_.run.touches_done(), 0);
  EXPECT_TRUE(store.touches(active_.run.id()).empty());
}

TEST_F(ManualTouchingTest, NothingIsWatchedOutsideOfExecute) {
  EXPECT_TRUE(manual_.awaits_touch());
  EXPECT_FALSE(manual_.guide(State::kHeld));
  EXPECT_FALSE(manual_.awaits_touch());
}

TEST_F(ManualTouchingTest, WithoutATouchLeftTheStepIsDone) {
  while (active_.run.next()) active_.run.skip_next();
  run(manual_.await_touch(active_));
  EXPECT_EQ(status.state(), State::kCompleting);
}

TEST_F(ManualTouchingTest, WithTheLastTouchTakenBackNothingIsIdentifiedAnyMore) {
  // As many as the parameters need, as a person would make them.
  for (const calib::PlannedTouch& planned : plan_of_owners().touches.touches) {
    StoredTouch touch{
        .number = active_.run.touches_done() + 1, .plane = planned.face + 1, .role = planned.role};
    touch.joints = to_wire(planned.joints);
    store.append_touch(active_.run.id(), touch);
    active_.run.add(touch);
  }
  active_.run.identify();
  ASSERT_EQ(active_.run.latest().status, calib::IdentificationStatus::kConverged);
  while (active_.run.touches_done() > 0) {
    manual_.undo(active_);
    run(manual_.await_touch(active_));
  }
  active_.run.identify();
  EXPECT_NE(active_.run.latest().status, calib::IdentificationStatus::kConverged);
  EXPECT_FALSE(active_.run.predicted_tip_rms_m());
  EXPECT_TRUE(store.touches(active_.run.id()).empty());
}

}  // namespace
}  // namespace cell
