// Start and end of an application, its libraries and its data.
#include "sim_controller/val3/machine/machine.hpp"

#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

TEST(MachineOf, AnApplicationEndsWithItsLastTaskAndStopRunsThen) {
  SmallProject project;
  project.number("n", 2)
      .program("work", "delay(0.02)\nn[0]=1")
      .program("start", "taskCreate \"work\",10,work()");
  project.program("stop", "n[1]=n[0]+1");
  Running run(project);
  run.ticks(3);
  EXPECT_FALSE(run.machine().ended());
  run.ticks(10);
  EXPECT_TRUE(run.machine().ended());
  EXPECT_EQ(run.number("n", 1), 2);
}

TEST(MachineOf, StopFromThePendantLeavesTheOthersAliveUntilItsProgramHasEnded) {
  SmallProject project;
  project.number("n", 3).program("work", "while true\nn[0]=n[0]+1\ndelay(0)\nendWhile");
  project.program("start", "taskCreate \"work\",10,work()\nwhile true\nn[2]=n[2]+1\ndelay(0)\nendWhile");
  project.program("stop", "n[1]=n[0]\ndelay(0.1)\nn[1]=n[0]-n[1]");
  Running run(project);
  run.ticks(5);
  run.machine().stop();
  run.ticks(1);
  const double started = run.number("n", 2);
  run.ticks(40);
  EXPECT_TRUE(run.machine().ended());
  EXPECT_EQ(run.number("n", 2), started) << "the start task went at once";
  EXPECT_GT(run.number("n", 1), 10) << "the other one ran on";
  EXPECT_TRUE(run.controller.tasks().empty());
}

TEST(MachineOf, ASecondStartFindsWhatTheFirstRunLeft) {
  SmallProject project;
  project.number("n").program("start", "n=n+1");
  Running run(project);
  run.ticks(4);
  run.machine().start();
  run.ticks(4);
  EXPECT_EQ(run.number("n"), 2);
}

TEST(MachineOf, AFailedTaskKeepsTheApplicationAliveAndGoesOnWhereItIsTold) {
  SmallProject project;
  project.number("n", 3).program("fails", "n[0]=1\nn[0]=n[7]\nn[1]=1\nwait(false)");
  project.program("start",
                  "taskCreate \"fails\",10,fails()\ndelay(0.02)\nn[2]=taskStatus(\"fails\")\n"
                  "taskResume(\"fails\",1)\ndelay(0.02)\nn[2]=n[2]+taskStatus(\"fails\")");
  Running run(project);
  run.ticks(20);
  EXPECT_EQ(run.number("n", 0), 1) << "what was changed stays";
  EXPECT_EQ(run.number("n", 1), 1) << "the line was skipped";
  EXPECT_EQ(run.number("n", 2), kErrorIndex + 1);
}

TEST(MachineOf, DataHaveTheDefaultsOfTheirTypeWhereNothingIsStored) {
  SmallProject project;
  project.data("m", "mdesc", "<Value key=\"0\" vel=\"40\"/>", 2).number("n", 8).data("c", "configRx", "");
  project.program("start",
                  "n[0]=m.vel\nn[1]=m.accel\nn[2]=m.tvel\nn[3]=m[1].vel\nn[4]=m.leave\n"
                  "n[5]=sel(m.blend==joint,1,0)\nn[6]=sel(c.shoulder==ssame,1,0)\nm.blend=off\nn[7]=sel(m."
                  "blend==off,1,0)");
  Running run(project);
  run.ticks(3);
  const std::vector<double> expected{40, 100, 99999, 100, 50, 1, 1, 1};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(run.number("n", i), expected[i]) << i << run.log();
}

TEST(MachineOf, NamesThatAreNoneAreRefused) {
  SmallProject project;
  project.number("n").program("start", "");
  Running run(project);
  EXPECT_THROW((void)run.machine().number("none"), std::out_of_range);
  EXPECT_THROW((void)run.machine().number("n", 1), std::out_of_range);
  EXPECT_THROW((void)run.machine().truth("n"), std::bad_variant_access);
  EXPECT_THROW(run.machine().fail_task("none", 1), std::out_of_range);
}

TEST(MachineOf, RecursionWithoutEndIsRunMemory) {
  SmallProject project;
  project.number("n").program("deep", "n=n+1\ncall deep()").program("start", "call deep()");
  Running run(project);
  run.ticks(5);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorRunMemory);
  EXPECT_GT(run.number("n"), 100);
}

}  // namespace
}  // namespace val3
