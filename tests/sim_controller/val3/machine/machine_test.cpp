// Start and end of an application, its libraries and its data.
#include "sim_controller/val3/machine/machine.hpp"

#include "sim_controller/val3/program/run_memory.hpp"
#include "tests/sim_controller/val3/files/project_folder.hpp"
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
  const std::size_t calls = kUsualStackBytes / kCallBytes;
  EXPECT_EQ(run.number("n"), static_cast<double>(calls - 1)) << "one call is start()";
  EXPECT_EQ(run.machine().tasks().at(0).error,
            "run memory is exhausted: deep would be call 157 on the stack, with 5024 bytes (estimated) of "
            "stackSize 5000");
}

TEST(MachineOf, RunMemoryIsThatOfTheProject) {
  SmallProject project;
  project.stack(400'000).number("n").program("deep", "n=n+1\nif n<2000\ncall deep()\nendIf");
  project.program("start", "call deep()\nn=n+1");
  Running run(project);
  run.ticks(5);
  EXPECT_EQ(run.number("n"), 2001) << "2,000 calls are held, and all come back";
}

TEST(MachineOf, LocalsThatGrewHaveTheirSizeAgainInTheNextCall) {
  SmallProject project;
  project.number("n", 3).program("grow", "append(l_a)\nl_a[2]=7\nn[1]=size(l_a)\nn[2]=l_a[0]",
                                 SmallProject::local("l_a", "num", 2));
  project.program("start", "for n[0]=1 to 3\ncall grow()\nendFor\nwait(false)");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.machine().task_status("small~"), 1) << run.log();
  EXPECT_EQ(run.number("n", 1), 3);
}

TEST(MachineOf, ParametersThatGrewAreOneValueAgainInTheNextCall) {
  SmallProject project;
  project.number("n", 3).program(
      "grow", "n[1]=size(x_n)\nn[2]=x_n[0]\nif n[0]==1\nappend(x_n)\nelse\ndelete(x_n[0])\nendIf",
      SmallProject::parameters(SmallProject::parameter("x_n", "num", "xsi:type=\"element\"")));
  project.program("start", "for n[0]=1 to 3\ncall grow(10*n[0])\nendFor\nwait(false)");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.machine().task_status("small~"), 1) << run.log();
  EXPECT_EQ(run.number("n", 1), 1);
  EXPECT_EQ(run.number("n", 2), 30);
}

TEST(MachineOf, LocalsTakeRunMemoryWhileTheirCallLasts) {
  SmallProject project;
  project.number("n").program("large", "l_n[0]=1", SmallProject::local("l_n", "num", 600));
  project.program("start", "for n=1 to 20\ncall large()\nendFor\ncall larger()");
  project.program("larger", "l_n[0]=1", SmallProject::local("l_n", "num", 100'000));
  Running run(project);
  run.ticks(5);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorRunMemory);
  EXPECT_EQ(run.number("n"), 21) << "each call gives its memory back";
}

/// A program that takes some 80,000 bytes and stays.
SmallProject& with_large(SmallProject& project) {
  return project.stack(400'000).number("n").program("large", "l_n[0]=1\nwait(false)",
                                                    SmallProject::local("l_n", "num", 10'000));
}

TEST(MachineOf, AllTasksTogetherHaveABoundOfRunMemory) {
  SmallProject project;
  with_large(project).program("start",
                              "for n=1 to 100\ntaskCreate \"t\"+toString(\"\",n),10,large()\nendFor");
  constexpr std::size_t kMost = 1'000'000;
  Running run(project, {.run_memory_bytes = kMost});
  run.ticks(5);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorRunMemory);
  constexpr std::size_t kLarge = kCallBytes + kVariableBytes + 80'000 + kTaskBytes;
  EXPECT_EQ(run.number("n"), std::floor((kMost - kCallBytes - kTaskBytes) / static_cast<double>(kLarge)) + 1);
  EXPECT_NE(run.log().find("all tasks together would take"), std::string::npos) << run.log();
}

TEST(MachineOf, ATaskThatGoesGivesItsRunMemoryBack) {
  SmallProject project;
  with_large(project).program(
      "start", "for n=1 to 100\ntaskCreate \"t\",10,large()\ntaskKill(\"t\")\ndelay(0.005)\nendFor\nn=1000");
  Running run(project, {.run_memory_bytes = 200'000});
  run.ticks(500);
  EXPECT_EQ(run.number("n"), 1000) << run.log();
}

TEST(MachineOf, ATaskThatIsNotMadeGivesItsRunMemoryBack) {
  SmallProject project;
  with_large(project).flag("b").program("again", "taskCreate \"t\",10,large()\nb=true");
  project.program("start",
                  "taskCreate \"t\",10,large()\nfor n=1 to 20\ntaskCreate \"a\",10,again()\ndelay(0.01)\n"
                  "taskKill(\"a\")\ndelay(0.01)\nendFor\ntaskCreate \"u\",10,large()\nn=1000");
  Running run(project, {.run_memory_bytes = 300'000});
  run.ticks(300);
  EXPECT_EQ(run.number("n"), 1000) << run.log();
  EXPECT_FALSE(run.truth("b")) << "there is a task of that name";
}

TEST(MachineOf, AFieldHasTheSizeThatItsVariableStores) {
  const std::string field =
      "<Data name=\"nData\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"2\"/>\n";
  ProjectFolder folder;
  folder.project("typ", "<Database><Data file=\"typ.dtx\"/></Database>\n").data("typ/typ.dtx", field);
  folder.small(
      "<Data name=\"n\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"4\"/>\n"
      "<Data name=\"q\" access=\"private\" xsi:type=\"array\" type=\"typ\" size=\"2\"><Value "
      "key=\"0\"><Field "
      "name=\"nData\" xsi:type=\"array\" type=\"num\" size=\"12\"><Value key=\"11\" "
      "value=\"7\"/></Field></Value>"
      "</Data>\n",
      "<Types><Type name=\"typ\" path=\"Disk://typ/typ.pjx\"/></Types>\n");
  folder.program("app/start.pgx",
                 "n[0]=size(q.nData)\nn[1]=q.nData[11]\nn[2]=size(q[1].nData)\nq[1].nData[2]=1\nn[3]=1\n");
  Cabinet cabinet;
  Controller controller(
      folder.path() / "app" / "app.pjx", cabinet, [] {}, MachineLimits{});
  controller.machine().start();
  controller.tick();
  EXPECT_EQ(controller.machine().number("n", 0), 12);
  EXPECT_EQ(controller.machine().number("n", 1), 7);
  EXPECT_EQ(controller.machine().number("n", 2), 2) << "the type's own where nothing is stored";
  EXPECT_EQ(controller.machine().task_status("app~"), kErrorIndex);
}

}  // namespace
}  // namespace val3
