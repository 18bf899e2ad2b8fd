// Points, frames and tools: manual 6, pages 107 to 137.
#include "sim_controller/val3/machine/geometry.hpp"
#include "tests/sim_controller/val3/machine/evaluated.hpp"

namespace val3 {
namespace {

TEST(Geometry, AnglesTurnAboutXThenTheNewYThenTheNewZ) {
  const Trsf back = trsf_of(isometry({1, 2, 3, 10, -20, 170}));
  EXPECT_NEAR(back.x, 1, 1e-12);
  EXPECT_NEAR(back.rx, 10, 1e-9);
  EXPECT_NEAR(back.ry, -20, 1e-9);
  EXPECT_NEAR(back.rz, 170, 1e-9);
  const Eigen::Vector3d x = isometry({0, 0, 0, 90, 0, 90}).linear() * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((x - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12)
      << "rz turns x to the new y, which rx has put on z";
  EXPECT_EQ(trsf_of(isometry({0, 0, 0, 30, 90, 40})).rx, 0) << "manual 6, page 115";
}

TEST(Geometry, AnInverseUndoesAndUnitsScaleLengthsOnly) {
  const Trsf t{10, -20, 30, 40, 50, 60};
  const Trsf none = composed(t, inverse(t));
  for (const double part : {none.x, none.y, none.z, none.rx, none.ry, none.rz}) EXPECT_NEAR(part, 0, 1e-9);
  EXPECT_EQ(scaled(t, 25.4).x, 254);
  EXPECT_EQ(scaled(t, 25.4).rx, 40);
  EXPECT_EQ(distance({0, 0, 0}, {3, 4, 0}), 5);
}

SmallProject& with_points(SmallProject& project) {
  project.data("f", "frame", "<Value key=\"0\" x=\"100\" rz=\"90\" fatherId=\"world[0]\"/>");
  project.data("fTop", "frame", "<Value key=\"0\" z=\"10\" fatherId=\"f[0]\"/>");
  project.data("p", "pointRx", "<Value key=\"0\" x=\"1\" y=\"2\" z=\"3\" fatherId=\"fTop[0]\"/>", 3);
  project.data("kTool", "tool", "<Value key=\"0\" z=\"50\" fatherId=\"flange[0]\"/>");
  return with_variables(project);
}

TEST(Geometry, APointIsInItsFrameAndThatInItsOwn) {
  SmallProject project;
  with_points(project).program("start",
                               "t[0]=position(p,world)\nt[1]=position(fTop,world)\nt[2]=position(p,f)\n"
                               "n[0]=distance(p,appro(p,{0,0,-5,0,0,0}))\nt[3]=position(kTool,flange)");
  project.number("out", 12);
  project.program("copy",
                  "out[0]=t[0].x\nout[1]=t[0].y\nout[2]=t[0].z\nout[3]=t[0].rz\nout[4]=t[1].z\nout[5]=t[2]."
                  "x\nout[6]=t[3].z");
  project.program("stop", "call copy()");
  Running run(project);
  run.ticks(6);
  EXPECT_NEAR(run.number("out", 0), 98, 1e-9) << "y of the frame is -x of the world" << run.log();
  EXPECT_NEAR(run.number("out", 1), 1, 1e-9);
  EXPECT_NEAR(run.number("out", 2), 13, 1e-9);
  EXPECT_NEAR(run.number("out", 3), 90, 1e-9);
  EXPECT_NEAR(run.number("out", 4), 10, 1e-9);
  EXPECT_NEAR(run.number("out", 5), 1, 1e-9);
  EXPECT_NEAR(run.number("out", 6), 50, 1e-9);
  EXPECT_NEAR(run.number("n", 0), 5, 1e-9);
}

TEST(Geometry, ComposeTurnsAboutTheFramesOriginAndApproOnThePointsAxes) {
  SmallProject project;
  with_points(project).program(
      "start",
      "p[1]=compose(p,world,{0,0,0,0,0,90})\nt[0]=position(p[1],world)\n"
      "n[0]=t[0].x\nn[1]=t[0].y\nlink(p[2],f)\nt[1]=position(p[2],world)\nn[2]=t[1].x");
  Running run(project);
  run.ticks(3);
  EXPECT_NEAR(run.number("n", 0), -1, 1e-9) << run.log();
  EXPECT_NEAR(run.number("n", 1), 98, 1e-9);
  EXPECT_NEAR(run.number("n", 2), 100, 1e-9) << "the same numbers in another frame";
}

TEST(Geometry, AToolIsLinkedToAnother) {
  SmallProject project;
  with_points(project).data("kTip", "tool", "<Value key=\"0\" z=\"5\" fatherId=\"flange[0]\"/>");
  project.program("start",
                  "link(kTip,kTool)\nt[0]=position(kTip,flange)\nn[0]=t[0].z\nlink(kTip,flange)\n"
                  "t[0]=position(kTip,flange)\nn[1]=t[0].z");
  Running run(project);
  run.ticks(2);
  EXPECT_NEAR(run.number("n", 0), 55, 1e-9) << run.log();
  EXPECT_NEAR(run.number("n", 1), 5, 1e-9);
}

TEST(Geometry, AFrameIsMadeOfThreePoints) {
  SmallProject project;
  with_points(project);
  project.data("q", "pointRx",
               "<Value key=\"0\" x=\"5\" fatherId=\"world[0]\"/><Value key=\"1\" x=\"5\" y=\"9\" "
               "fatherId=\"world[0]\"/>"
               "<Value key=\"2\" x=\"1\" y=\"9\" fatherId=\"world[0]\"/>",
               3);
  project.program(
      "start",
      "n[0]=setFrame(q[0],q[1],q[2],f)\nn[1]=f.trsf.x\nn[2]=f.trsf.rz\nn[3]=setFrame(q[0],q[0],q[2],f)\n"
      "n[4]=setFrame(q[0],q[1],q[1],f)");
  Running run(project);
  run.ticks(3);
  EXPECT_EQ(run.number("n", 0), 0) << run.log();
  EXPECT_NEAR(run.number("n", 1), 5, 1e-9);
  EXPECT_NEAR(run.number("n", 2), 90, 1e-9);
  EXPECT_EQ(run.number("n", 3), -1);
  EXPECT_EQ(run.number("n", 4), -2);
}

TEST(Geometry, WithoutItsFrameAPointIsNowhere) {
  SmallProject project;
  with_points(project).program("start", "n[0]=distance(l_p,p)", SmallProject::local("l_p", "pointRx"));
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorPointWithoutFrame);
}

TEST(Geometry, PosesAreGoneBetweenAndTurnedOntoAxes) {
  SmallProject project;
  with_variables(project).program(
      "start",
      "t[0]=interpolateL({0,0,0,0,0,0},{10,0,0,0,0,90},0.5)\nn[0]=t[0].x\nn[1]=t[0].rz\n"
      "t[1]=align({1,2,3,5,4,0},{0,0,0,0,0,0})\nn[2]=t[1].x\nn[3]=abs(t[1].rx)+abs(t[1].ry)\n"
      "t[2]=interpolateL({0,0,0,0,0,0},{10,0,0,0,0,90},2)");
  Running run(project);
  run.ticks(2);
  EXPECT_NEAR(run.number("n", 0), 5, 1e-9) << run.log();
  EXPECT_NEAR(run.number("n", 1), 45, 1e-9);
  EXPECT_EQ(run.number("n", 2), 1);
  EXPECT_NEAR(run.number("n", 3), 0, 1e-9);
  EXPECT_EQ(run.machine().task_status("small~"), kErrorParameter) << "a share from -1 to 2";
}

TEST(Geometry, WorldAndFlangeAreVariablesOfOneElement) {
  SmallProject project;
  with_points(project)
      .data("m", "mdesc", "")
      .program(
          "go",
          "n[1]=x_tool.trsf.z+x_frame.trsf.x\nt=position(p,x_frame)\nn[2]=t.x\nmovej(j,x_tool,m)\nn[3]=1",
          SmallProject::parameters(
              SmallProject::parameter("x_tool", "tool", "xsi:type=\"element\" use=\"reference\"") +
              SmallProject::parameter("x_frame", "frame", "xsi:type=\"element\" use=\"reference\"")));
  project.program("start", "n[0]=flange.trsf.z+world.trsf.x+1\ncall go(flange,world)");
  Running run(project);
  run.ticks(3);
  EXPECT_EQ(run.number("n", 0), 1) << run.log();
  EXPECT_EQ(run.number("n", 1), 0);
  EXPECT_NEAR(run.number("n", 2), 98, 1e-9) << "as position(p,world)";
  EXPECT_EQ(run.number("n", 3), 1);
}

TEST(Geometry, WorldAndFlangeThatAreChangedFailAtTheNextCalculation) {
  const std::vector<std::pair<std::string, int>> cases{
      {"world.trsf.x=5\nn[1]=1\nt=position(p,world)", kErrorWorldChanged},
      {"resize(world,1,0)\nn[1]=1\nt=position(p,f)", kErrorWorldChanged},
      {"flange=kTool\nn[1]=1\nt=position(kTool,flange)", kErrorFlangeChanged}};
  for (const auto& [lines, error] : cases) {
    SmallProject project;
    with_points(project).program("start", lines + "\nn[1]=2");
    Running run(project);
    run.ticks(3);
    EXPECT_EQ(run.machine().task_status("small~"), error) << lines << run.log();
    EXPECT_EQ(run.number("n", 1), 1) << lines;
  }
}

TEST(Geometry, AResultThatIsTooLargeForANumberIsAnError) {
  const std::string large = "n[1]=power(10,308)*1.5\n";
  for (const std::string line : {"j[1]=j[0]+j[0]", "j[1]=j[1]-j[0]-j[0]", "t[1]=t[0]*t[0]",
                                 "n[0]=distance(t[0],t[1])", "t[1]=interpolateL(t[0],t[1],1.5)"}) {
    SmallProject project;
    with_variables(project).program("start",
                                    large + "j[0].j1=n[1]\nt[0].x=n[1]\nt[1].x=-n[1]\n" + line + "\nn[2]=1");
    Running run(project);
    run.ticks(3);
    EXPECT_EQ(run.machine().task_status("small~"), kErrorArgument) << line << run.log();
    EXPECT_EQ(run.number("n", 2), 0) << line;
  }
}

TEST(Geometry, AToolInBracesHasItsGripperAndTimes) {
  SmallProject project;
  with_points(project).data("dq", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%Q0\"/>");
  project.program(
      "start",
      "kTool={{0,0,70,0,0,0},dq,0.5,0.25}\nn[0]=kTool.trsf.z\nn[1]=kTool.otime\nn[2]=kTool.ctime\n"
      "kTool.gripper=true\nb[0]=dq");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.number("n", 0), 70);
  EXPECT_EQ(run.number("n", 1), 0.5);
  EXPECT_EQ(run.number("n", 2), 0.25);
  EXPECT_TRUE(run.truth("b")) << "the gripper is that output";
}

}  // namespace
}  // namespace val3
