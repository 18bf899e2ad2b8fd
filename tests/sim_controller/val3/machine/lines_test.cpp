// What the machine makes of the language, on programs of a few lines.
#include <gtest/gtest.h>

#include <limits>

#include "tests/val3/running.hpp"

namespace val3 {
namespace {

TEST(Language, ReckonsWithNumbers) {
  SmallProject project;
  project.number("n", 8).program(
      "start",
      "n[0]=1+2*3\n// a comment\nn[1]=(1+2)*3\nn[2]=7%4-1\nn[3]=-n[0]/2\n"
      "n[4]=round(2.5)+abs(-1)\nn[5]=roundDown(-0.5)\nn[6]=sel(1<2,10,20)\nn[7]=limit(7,0,5)");
  Running run(project);
  run.ticks(1);
  const std::vector<double> expected{7, 9, 2, -3.5, 4, -1, 10, 5};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(run.number("n", i), expected[i]) << i;
}

TEST(Language, ComparesAndJoinsConditions) {
  SmallProject project;
  project.number("n").program("start",
                              "if 1<2 and !(3<=2) and (false or 2!=3)\n n=n+1\nendIf\n"
                              "if 1>=2\n n=n+10\nelseIf \"a\"==\"a\"\n n=n+100\nelse\n n=n+1000\nendIf\n"
                              "if false\n n=n+10000\nelse\n n=n+20000\nendIf");
  Running run(project);
  run.ticks(1);
  EXPECT_EQ(run.number("n"), 20101);
}

TEST(Language, LoopsCountUpAndDownAndUntil) {
  SmallProject project;
  project.number("n", 5).program("start",
                                 "for n[0]=1 to 4\n n[1]=n[1]+n[0]\nendFor\n"
                                 "for n[0]=4 to 1 step -2\n n[2]=n[2]+n[0]\nendFor\n"
                                 "while n[3]<7\n n[3]=n[3]+3\nendWhile\n"
                                 "do\n n[4]=n[4]+1\nuntil n[4]>=5");
  Running run(project);
  run.ticks(2);
  EXPECT_EQ(run.number("n", 1), 10);
  EXPECT_EQ(run.number("n", 2), 6);
  EXPECT_EQ(run.number("n", 3), 9);
  EXPECT_EQ(run.number("n", 4), 5);
}

TEST(Language, SwitchTakesOneCase) {
  SmallProject project;
  project.number("n", 2).program(
      "start",
      "for n[0]=1 to 4\nswitch n[0]\n case 1\n  n[1]=n[1]+1\n break\n case 2, 3\n"
      "  n[1]=n[1]+10\n break\n default\n  n[1]=n[1]+100\n break\nendSwitch\nendFor");
  Running run(project);
  run.ticks(1);
  EXPECT_EQ(run.number("n", 1), 121);
}

TEST(Language, ParametersByValueAreCopiesAndThoseByReferenceArePlaces) {
  SmallProject project;
  project.number("n", 6).data("j", "jointRx", "<Value key=\"0\" j3=\"7\"/>");
  project.program(
      "add", "x_nCopy=x_nCopy+1\nx_nPlace=x_nCopy+l_n[1]\nx_nList[1]=9\nx_jArm.j3=x_jArm.j3*2",
      SmallProject::parameters(
          SmallProject::parameter("x_nCopy", "num", "xsi:type=\"element\"") +
          SmallProject::parameter("x_nPlace", "num", "xsi:type=\"element\" use=\"reference\"") +
          SmallProject::parameter("x_nList", "num", "xsi:type=\"array\" use=\"reference\"") +
          SmallProject::parameter("x_jArm", "jointRx", "xsi:type=\"element\" use=\"reference\"")) +
          SmallProject::local("l_n", "num", 2));
  project.program("start", "n[0]=4\ncall add(n[0],n[1],n[2],j)");
  Running run(project);
  run.ticks(1);
  EXPECT_EQ(run.number("n", 0), 4);
  EXPECT_EQ(run.number("n", 1), 5);
  EXPECT_EQ(run.number("n", 3), 9) << "an array argument begins at the element that is named";
  EXPECT_EQ(run.machine().joint("j")[2], 14);
}

TEST(Language, TextsAreCutAndRead) {
  SmallProject project;
  project.data("s", "string", "", 3).number("n", 2).flag("b");
  project.program(
      "start",
      "s[0]=mid(getVersion(\"VAL3\"),1,1)+left(\"abc\",2)+right(\"abc\",1)\ns[1]=toNum(\"3.5 mm\",n[0],b)\n"
      "s[2]=toString(\"5.1\",2.25)\nn[1]=find(\"abc\",\"c\")+len(\"four\")");
  Running run(project);
  run.ticks(1);
  EXPECT_EQ(run.text("s", 0), "7abc");
  EXPECT_EQ(run.text("s", 1), "") << "what follows begins with the next number";
  EXPECT_EQ(run.number("n"), 3.5);
  EXPECT_TRUE(run.truth("b"));
  EXPECT_EQ(run.text("s", 2).size(), 5u);
  EXPECT_EQ(run.number("n", 1), 6);
}

TEST(Language, BinaryFormatsAreLittleEndian) {
  SmallProject project;
  project.number("bytes", 12).number("n", 3);
  project.program("start",
                  "n[0]=-2\ntoBinary(n,1,\"-4l\",bytes)\nn[0]=4294967295\ntoBinary(n,1,\"4l\",bytes[4])\n"
                  "n[0]=258\ntoBinary(n,1,\"2l\",bytes[8])\nfromBinary(bytes,4,\"-4l\",n[0])\n"
                  "fromBinary(bytes[4],4,\"4l\",n[1])\nfromBinary(bytes[8],2,\"2l\",n[2])");
  Running run(project);
  run.ticks(1);
  const std::vector<double> expected{254, 255, 255, 255, 255, 255, 255, 255, 2, 1, 0, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(run.number("bytes", i), expected[i]);
  EXPECT_EQ(run.number("n", 0), -2);
  EXPECT_EQ(run.number("n", 1), 4294967295.0);
  EXPECT_EQ(run.number("n", 2), 258);
}

TEST(Language, ALoopThatNeverWaitsLeavesTheOthersTheirTurns) {
  SmallProject project;
  project.number("n", 2).program("spin", "while true\nn[0]=n[0]+1\nendWhile");
  project.program("start", "taskCreate \"spin\",100,spin()\nwhile true\nn[1]=n[1]+1\ndelay(0)\nendWhile");
  Running run(project);
  run.ticks(50);
  EXPECT_GT(run.number("n", 0), 1000);
  EXPECT_GT(run.number("n", 1), 40);
}

TEST(Language, WhatIsNoNumberIsAnErrorWhereItIsUsed) {
  const std::map<std::string, int> statements{
      {"n[1]=n[n]", kErrorArgument}, {"n[1]=nTable[0,n]", kErrorArgument},
      {"delay(n)", kErrorParameter}, {"movej(j,flange,m)", kErrorInvalidMove},
      {"n=n+1", kErrorArgument},     {"j=j+j", kErrorArgument}};
  for (const auto& [statement, error] : statements) {
    SmallProject project;
    project.number("n", 2).flag("b").data("m", "mdesc", "").data("j", "jointRx", "");
    project.file_data(
        "<Data name=\"nTable\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"2 3\"/>");
    project.program("start", "wait(b)\n" + statement);
    Running run(project);
    run.ticks(2);
    run.machine().set_number("n", std::numeric_limits<double>::quiet_NaN());
    run.machine().set_joint("j", {std::numeric_limits<double>::infinity(), 0, 0, 0, 0, 0});
    run.machine().set_truth("b", true);
    run.ticks(5);
    EXPECT_EQ(run.machine().task_status("small~"), error) << statement << '\n' << run.log();
  }
}

TEST(Language, RunTimeErrorsEndTheTaskWithTheirNumber) {
  const std::map<std::string, int> statements{{"n=1/n", kErrorDivision},
                                              {"n=n[5]", kErrorIndex},
                                              {"toBinary(n,1,\"8l\",n)", kErrorParameter},
                                              {"setLatch(di)", kErrorParameter},
                                              {"b=diNone", kErrorNotLinked},
                                              {"di=true", kErrorWriteToInput},
                                              {"m.decel=-1\nmovej(herej(),flange,m)", kErrorDecel},
                                              {"call start()", kErrorRunMemory}};
  for (const auto& [statement, error] : statements) {
    SmallProject project;
    project.number("n").flag("b").data("m", "mdesc", "");
    project.data("di", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I0\"/>");
    project.data("diNone", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I9\"/>");
    project.program("start", statement);
    Running run(project);
    run.ticks(20);
    EXPECT_EQ(run.machine().task_status("small~"), error) << statement << '\n' << run.log();
  }
}

}  // namespace
}  // namespace val3
