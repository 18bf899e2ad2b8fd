#include "sim_controller/run_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim_controller/small_run.hpp"
#include "tests/val3/small_project.hpp"

namespace sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_small;
using testing::SmallRun;

/// Programs that move, on the demo cell.
class RunWatchTest : public ::testing::Test {
 protected:
  RunWatchTest() {
    project_.data("m", "mdesc", "");
    project_.data("jGood", "jointRx", "<Value key=\"0\" j1=\"5\" j2=\"10\" j3=\"90\" j5=\"60\"/>");
    project_.data("jBad", "jointRx", "<Value key=\"0\" j3=\"150\"/>");
    project_.data("jTable", "jointRx", "<Value key=\"0\" j1=\"-90\" j2=\"90\" j3=\"90\"/>");
  }
  SmallRun run(const std::string& lines, const std::string& script = "0 power on\n3 end\n") {
    return run_small(project_.program("start", lines).write().path(), script);
  }

  val3::SmallProject project_;
};

TEST_F(RunWatchTest, AnImpossibleMoveThatNothingFollowsFailsTheRunWithItsCauseAndLine) {
  const SmallRun ran = run("movej(jBad,flange,m)\nwait(isEmpty())\ndelay(0.1)");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("log: error 150: movej at start.pgx:3 of task small~: joint 3 at 150 deg "
                              "is outside its range"),
                    HasSubstr("FAILED error 150 was not handled by resetMotion(): movej at"),
                    HasSubstr("1 failures")));
}

TEST_F(RunWatchTest, TheTaskThatItStopsIsAFailureOfItsOwn) {
  const SmallRun ran = run("movej(jBad,flange,m)\nwaitEndMove()");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.out, AllOf(HasSubstr("FAILED task small~ ends with error 150 at start.pgx:4"),
                             HasSubstr("2 failures")));
}

TEST_F(RunWatchTest, AProgramThatResetsTheMotionHasHandledIt) {
  project_.program("goes", "movej(jBad,flange,m)\nwaitEndMove()");
  const SmallRun ran = run(
      "taskCreate \"goes\",10,goes()\nwait(taskStatus(\"goes\")==150)\nresetMotion()\ntaskKill(\"goes\")\n"
      "movej(jGood,flange,m)\nwaitEndMove()\nlogMsg(\"there\")");
  EXPECT_EQ(ran.code, kRanWell) << ran.out;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("log: error 150: movej at goes.pgx:3 of task goes: joint 3"),
                             HasSubstr("the program handles the failed move"), HasSubstr("log: there"),
                             Not(HasSubstr("FAILED"))));
}

TEST_F(RunWatchTest, AResetBehindTheSecondOfTwoFailuresHandlesBoth) {
  const SmallRun ran =
      run("movej(jBad,flange,m)\ndelay(0.1)\nresetMotion()\nmovej(jBad,flange,m)\ndelay(0.1)\nresetMotion()\n"
          "movej(jBad,flange,m)\ndelay(0.1)");
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("FAILED error 150 was not handled by resetMotion(): movej at start.pgx:9"),
                    HasSubstr("1 failures")));
}

TEST_F(RunWatchTest, AResetOfStopCleansUpAndHandlesNothing) {
  project_.program("stop", "resetMotion()");
  const SmallRun by_itself = run("movej(jBad,flange,m)\ndelay(0.1)");
  EXPECT_THAT(by_itself.out, HasSubstr("1 failures"));
  const SmallRun by_pendant = run("movej(jBad,flange,m)\nwaitEndMove()", "0 power on\n1 stop\n3 end\n");
  EXPECT_THAT(by_pendant.out, HasSubstr("2 failures"));
}

TEST_F(RunWatchTest, AnImpossibleMoveThatIsStillStoredAtTheEndIsAFailure) {
  const SmallRun ran = run("movej(jGood,flange,m)\nmovej(jBad,flange,m)");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(
      ran.out,
      AllOf(HasSubstr("FAILED a stored move is impossible, its turn did not come: movej at start.pgx:4"),
            HasSubstr("stored moves that were not completed: 1\n")));
  const SmallRun without_power = run("movej(jGood,flange,m)\nwaitEndMove()", "0 power off\n1 end\n");
  EXPECT_EQ(without_power.code, kRanWell);
  EXPECT_THAT(without_power.out, HasSubstr("stored moves that were not completed: 1; the power is off"));
}

TEST_F(RunWatchTest, ACollisionIsAFailureThatSaysWhatHitWhat) {
  const SmallRun ran = run("movej(jTable,flange,m)\nwaitEndMove()", "0 power on\n2 page\n");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("FAILED collision: stem hit table"),
                    HasSubstr("power is off: of the collision, stem hit table"), HasSubstr("1 failures")));
}

TEST_F(RunWatchTest, PowerThatGoesOffIsToldWithItsCause) {
  const SmallRun program = run("disablePower()\ndelay(0.1)");
  EXPECT_EQ(program.code, kRanWell);
  EXPECT_THAT(program.out, HasSubstr("power is off: by the program"));
  const SmallRun script = run("delay(5)", "0 power on\n0.5 estop press\n1 end\n");
  EXPECT_THAT(script.out, HasSubstr("power is off: line 2 of the script"));
  EXPECT_THAT(run("delay(1)").out, Not(HasSubstr("power is off")));
}

}  // namespace
}  // namespace sim
