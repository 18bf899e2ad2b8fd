// Tasks, time, sockets and motion as a cabinet gives them to a program.
#include <gtest/gtest.h>

#include <cmath>

#include "sim_controller/val3/machine/geometry.hpp"
#include "tests/val3/running.hpp"

namespace val3 {
namespace {

TEST(Tasks, SynchronousOnesRunOncePerPeriod) {
  SmallProject project;
  project.number("n", 2).flag("bOver").data("s", "string", "<Value key=\"0\" value=\"fast\"/>");
  project.program("count", "while true\nx_n=x_n+1\ndelay(0)\nendWhile",
                  SmallProject::parameters(
                      SmallProject::parameter("x_n", "num", "xsi:type=\"element\" use=\"reference\"")));
  project.program("start",
                  "taskCreateSync s,0.004,bOver,count(n[0])\ntaskCreateSync \"slow\",0.02,bOver,count(n[1])");
  Running run(project);
  run.ticks(101);
  EXPECT_EQ(run.number("n", 0), 100);
  EXPECT_EQ(run.number("n", 1), 20);
  EXPECT_FALSE(run.truth("bOver"));
  EXPECT_EQ(run.machine().task_status("small~"), -1) << "start has returned";
}

TEST(Tasks, ASynchronousOneThatDoesNotFinishTellsAnOverrunAndGoesOn) {
  SmallProject project;
  project.number("n").flag("bOver");
  project.program("count", "while true\nfor n=1 to 20\nendFor\ndelay(0)\nendWhile");
  project.program("start", "taskCreateSync \"count\",0.004,bOver,count()");
  Running few(project, {.lines_per_period = 15});
  few.ticks(4);
  EXPECT_TRUE(few.truth("bOver"));
  EXPECT_EQ(few.machine().task_status("count"), 1);
  Running enough(project, {.lines_per_period = 100});
  enough.ticks(10);
  EXPECT_FALSE(enough.truth("bOver"));
}

TEST(Tasks, AThirdPeriodIsError32AndASecondTaskOfAName31) {
  SmallProject project;
  project.flag("bOver").program("idle", "while true\ndelay(0)\nendWhile");
  project.program("start",
                  "taskCreateSync \"a\",0.004,bOver,idle()\ntaskCreateSync \"b\",0.008,bOver,idle()\n"
                  "taskCreateSync \"c\",0.012,bOver,idle()");
  Running three(project);
  three.ticks(1);
  EXPECT_EQ(three.machine().task_status("small~"), kErrorPeriods);
  project.program("start", "taskCreate \"a\",10,idle()\ntaskCreate \"a\",10,idle()");
  Running twice(project);
  twice.ticks(1);
  EXPECT_EQ(twice.machine().task_status("small~"), kErrorTaskExists);
}

TEST(Tasks, AreSeenAndKilled) {
  SmallProject project;
  project.number("n", 3).program("fails", "n[2]=n[9]").program("idle", "while true\ndelay(0)\nendWhile");
  project.program("start",
                  "taskCreate \"fails\",10,fails()\ntaskCreate \"idle\",10,idle()\ndelay(0.02)\n"
                  "n[0]=taskStatus(\"fails\")\nn[1]=taskStatus(\"idle\")\nn[2]=taskStatus(\"none\")\n"
                  "taskKill(\"fails\")\ntaskKill(\"idle\")\ntaskKill(\"none\")");
  Running run(project);
  run.ticks(20);
  EXPECT_EQ(run.number("n", 0), kErrorIndex);
  EXPECT_EQ(run.number("n", 1), 1);
  EXPECT_EQ(run.number("n", 2), -1);
  EXPECT_TRUE(run.controller.tasks().empty());
}

TEST(Tasks, WaitForTimeAndForConditions) {
  SmallProject project;
  project.number("n", 4).flag("b").data("di", "dio", "<Value key=\"0\" link=\"FastIO\\fIn0\"/>");
  project.program(
      "start",
      "n[0]=clock()\ndelay(0.1)\nn[0]=clock()-n[0]\nb=watch(di==true,0.04)\nn[1]=clock()\n"
      "if b==false\n n[2]=1\nendIf\nif watch(di==true,10)\n n[2]=2\nendIf\nwait(di==false)\nn[3]=1");
  Running run(project);
  run.ticks(60);
  EXPECT_NEAR(run.number("n", 0), 0.1, 1e-9);
  EXPECT_NEAR(run.number("n", 1), 0.14, kTickSeconds + 1e-9);
  EXPECT_EQ(run.number("n", 2), 1);
  run.cabinet.inputs["FastIO\\fIn0"] = true;
  run.ticks(2);
  EXPECT_EQ(run.number("n", 2), 2);
  EXPECT_EQ(run.number("n", 3), 0);
  run.cabinet.inputs["FastIO\\fIn0"] = false;
  run.ticks(2);
  EXPECT_EQ(run.number("n", 3), 1);
}

/// Lines of a tick in which a program does nothing but `code`, a million values a line.
std::uint64_t lines_of_a_tick(const std::string& code) {
  SmallProject type("big");
  type.file_data("<Data name=\"n\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"1\"/>").write();
  SmallProject project;
  project.type(type).data("a", "big", "").data("b", "big", "");
  project.number("n", 1'000'000).number("k").flag("bOver");
  project.program("start", "resize(a.n,1,990000)\ndelay(0)\nwhile true\n" + code + "\nendWhile");
  Running run(project);
  run.ticks(1);
  const std::uint64_t before = run.machine().lines();
  run.ticks(1);
  EXPECT_EQ(run.machine().task_status("small~"), 1) << code << run.log();
  return run.machine().lines() - before;
}

TEST(Tasks, LinesThatMoveAMillionValuesEndATickSoon) {
  EXPECT_GT(lines_of_a_tick("k=k+1"), 3000U);
  for (const char* code :
       {"resize(n,1,0)\nresize(n,1,1000000)", "delete(n[0])\ninsert(n[0])", "b=a", "k=libSave()",
        "k=getData(\"n\",n)", "k=toBinary(n,1000000,\"1\",n)", "k=fromBinary(n,1000000,\"1\",n)"})
    EXPECT_LE(lines_of_a_tick(code), 12U) << code;
}

TEST(Tasks, ALineThatMovesMuchTakesTheTimeOfManyInAPeriod) {
  SmallProject project;
  project.number("n", 1000).number("k").flag("bOver");
  project.program("count", "while true\nk=getData(\"n\",n)\nk=getData(\"n\",n)\ndelay(0)\nendWhile");
  project.program("start", "taskCreateSync \"count\",0.004,bOver,count()");
  Running few(project, {.lines_per_period = 6});
  few.ticks(4);
  EXPECT_TRUE(few.truth("bOver")) << "each takes 3 more";
  Running enough(project, {.lines_per_period = 20});
  enough.ticks(4);
  EXPECT_FALSE(enough.truth("bOver"));
}

TEST(Sockets, AreReadAndWrittenWithReturnCodes) {
  SmallProject project;
  project.number("n", 3).number("in", 4).number("out", 3).data("si", "sio",
                                                               "<Value key=\"0\" link=\"Socket\\host\"/>");
  project.program("start",
                  "n[0]=sioCtrl(si,\"timeout\",-1)\nn[0]=sioGet(si,in)\ndelay(0.01)\nn[1]=sioGet(si,in[1])"
                  "\nout[0]=1\nout[1]=2\nout[2]=255\n"
                  "n[2]=sioSet(si,out)\ndelay(0.1)\nn[0]=sioGet(si,in)\nclearBuffer(si)");
  Running run(project);
  run.ticks(1);
  EXPECT_EQ(run.number("n", 0), -1) << "nobody is connected";
  Socket& socket = run.cabinet.sockets["Socket\\host"];
  ASSERT_TRUE(socket.connect());
  socket.to_controller = {7, 8, 9, 10};
  run.ticks(5);
  EXPECT_EQ(run.number("n", 1), 3) << "as many as there is room for";
  EXPECT_EQ(run.number("in", 3), 9);
  EXPECT_EQ(run.number("n", 2), 3);
  EXPECT_EQ(socket.to_host, (std::vector<std::uint8_t>{1, 2, 255}));
  socket.close_by_host();
  EXPECT_FALSE(socket.connect()) << "the dead connection still holds the socket";
  run.ticks(40);
  EXPECT_TRUE(socket.connect()) << "clearBuffer let it go";
}

TEST(Sockets, AReadWaitsUnlessItsTimeOutSaysOtherwise) {
  SmallProject project;
  project.number("n", 3).number("in", 4).data("si", "sio", "<Value key=\"0\" link=\"Socket\\host\"/>");
  project.program("start",
                  "n[0]=sioCtrl(si,\"nangle\",1)\nn[1]=sioCtrl(si,\"clients\",true)\nn[2]=sioGet(si,in)");
  Running run(project);
  Socket& socket = run.cabinet.sockets["Socket\\host"];
  run.ticks(1);
  ASSERT_TRUE(socket.connect());
  run.ticks(100);
  EXPECT_EQ(run.number("n", 0), -1) << "no such name";
  EXPECT_EQ(run.number("n", 1), -2) << "another type";
  EXPECT_EQ(run.number("n", 2), 0) << "still at its read";
  socket.to_controller = {7};
  run.ticks(1);
  EXPECT_EQ(run.number("n", 2), 1);
}

TEST(Arm, StandsFiftyFiftyNineFiftyAboveTheShoulderAtZero) {
  const NominalArm arm;
  const Trsf pose = scaled(trsf_of(arm.world_from_flange(Joint{})), 1000.0);
  EXPECT_NEAR(pose.x, 50, 1e-9);
  EXPECT_NEAR(pose.y, 50, 1e-9);
  EXPECT_NEAR(pose.z, 950, 1e-9);
  EXPECT_NEAR(std::abs(pose.rx) + std::abs(pose.ry) + std::abs(pose.rz), 0, 1e-9);
}

TEST(Arm, AnglesOfAFrameComeBack) {
  const Trsf back = trsf_of(isometry({1, 2, 3, 10, -20, 170}));
  EXPECT_NEAR(back.x, 1, 1e-9);
  EXPECT_NEAR(back.rx, 10, 1e-9);
  EXPECT_NEAR(back.ry, -20, 1e-9);
  EXPECT_NEAR(back.rz, 170, 1e-9);
}

const char* const kMoveData =
    "<Value key=\"0\" accel=\"100\" vel=\"100\" decel=\"100\" tmax=\"100\" rmax=\"200\" blend=\"off\"/>";

TEST(Arm, MovesToAPointAndStandsAtItsJoints) {
  SmallProject project;
  project.data("j", "jointRx", "<Value key=\"0\" j2=\"20\" j3=\"80\" j5=\"40\"/>", 2)
      .data("m", "mdesc", kMoveData);
  project.data("p", "pointRx", "<Value key=\"0\" fatherId=\"world[0]\"/>").number("n", 3).flag("b");
  project.program("start",
                  "p=jointToPoint(flange,world,j[0])\nn[0]=distance(p,jointToPoint(flange,world,j[1]))\n"
                  "movej(j[0],flange,m)\nwait(isEmpty() and isSettled())\n"
                  "p=appro(p,{0,0,-50,0,0,0})\nb=pointToJoint(flange,j[0],p,j[1])\nmovel(p,flange,m)\n"
                  "n[1]=clock()\nwait(isSettled() and isEmpty())\nn[1]=clock()-n[1]\n"
                  "n[2]=distance(here(flange,world),p)");
  Running run(project);
  run.ticks(3000);
  EXPECT_EQ(run.controller.tasks().size(), 0u) << run.log();
  EXPECT_TRUE(run.truth("b"));
  EXPECT_GT(run.number("n", 0), 100);
  EXPECT_NEAR(run.number("n", 1), 0.5, 0.03) << "50 mm at 100 mm/s";
  EXPECT_NEAR(run.number("n", 2), 0, 1e-6);
}

TEST(Arm, LatchKeepsTheJointsOfTheEdgeWhileTheArmStopsBehindIt) {
  SmallProject project;
  project.data("j", "jointRx", "<Value key=\"1\" j1=\"10\"/>", 2).data("m", "mdesc", kMoveData);
  project.data("di", "dio", "<Value key=\"0\" link=\"FastIO\\fIn0\"/>").flag("b");
  project.program("start",
                  "setLatch(di)\nmovej(j[1],flange,m)\nwait(di==true)\nresetMotion()\nwait(isSettled())\n"
                  "b=getLatch(j[0])\nj[1]=herej()");
  Running run(project);
  run.cabinet.world = [](Cabinet& cabinet) { cabinet.inputs["FastIO\\fIn0"] = cabinet.joints_deg[0] > 3.0; };
  run.ticks(600);
  EXPECT_TRUE(run.truth("b"));
  EXPECT_NEAR(run.machine().joint("j", 0)[0], 3.0, 0.05);
  EXPECT_GT(run.machine().joint("j", 1)[0], run.machine().joint("j", 0)[0]);
  EXPECT_LT(run.machine().joint("j", 1)[0], 6.0);
}

TEST(Arm, TheQueueMayLookEmptyForAMoment) {
  SmallProject project;
  project.data("j", "jointRx", "<Value key=\"0\" j1=\"10\"/>").data("m", "mdesc", kMoveData).flag("b", 2);
  project.program("look", "b[0]=isEmpty()\ndelay(0)\nb[1]=isEmpty()");
  project.program("start", "taskCreate \"look\",10,look()\nmovej(j,flange,m)");
  Running run(project);
  run.cabinet.looks_empty_at_first = true;
  run.ticks(3);
  EXPECT_TRUE(run.machine().truth("b", 0));
  EXPECT_FALSE(run.machine().truth("b", 1));
}

TEST(Arm, HeldItKeepsItsQueueAndAResetForgetsIt) {
  SmallProject project;
  project.data("j", "jointRx", "<Value key=\"0\" j1=\"10\"/>").data("m", "mdesc", kMoveData).flag("b");
  project.program("start", "movej(j,flange,m)\nwait(b)\nresetMotion()");
  Running run(project);
  run.ticks(10);
  run.cabinet.held = true;
  run.ticks(50);
  const double stood_deg = run.cabinet.joints_deg[0];
  EXPECT_GT(stood_deg, 0);
  EXPECT_LT(stood_deg, 10);
  EXPECT_TRUE(run.cabinet.is_settled());
  EXPECT_FALSE(run.cabinet.is_empty());
  run.cabinet.held = false;
  run.ticks(1000);
  EXPECT_NEAR(run.cabinet.joints_deg[0], 10, 1e-9);
  EXPECT_TRUE(run.cabinet.is_empty());
}

}  // namespace
}  // namespace val3
