// Each rule of the checks, broken once in a project that is otherwise right.
#include "tests/val3/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/val3/small_project.hpp"

namespace val3 {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string problems_of(SmallProject& project) {
  const Loaded loaded = load(project.write().path());
  std::string all;
  for (const Problem& problem : loaded.problems) all += problem.message() + "\n";
  for (const Problem& problem : check(loaded.application)) all += problem.message() + "\n";
  return all;
}

/// A right project with one synchronous task.
SmallProject& fill(SmallProject& project) {
  project.number("nCount").number("kLimit").flag("bOver");
  project.data("diDoor", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I0\"/>");
  project.program("work",
                  "while true\nbOver=diDoor\nif nCount<kLimit and "
                  "diDoor==true\nnCount=nCount+1\nendIf\ndelay(0)\nendWhile");
  project.program("start", "nCount=0\nbOver=false\ntaskCreateSync \"work\",0.004,bOver,work()");
  project.program("stop", "taskKill(\"work\")");
  return project;
}

TEST(Checks, ARightProjectHasNoProblems) {
  SmallProject project;
  EXPECT_THAT(problems_of(fill(project)), IsEmpty());
}

TEST(Checks, NameFileAndLineOfEachMistakeInStart) {
  const std::map<std::string, std::string> mistakes{
      {"nCount=nNone", "start.pgx:6: nothing is called nNone"},
      {"nCount=\"text\"", "start.pgx:6: string where num is wanted"},
      {"call none()", "start.pgx:6: no program is called none"},
      {"call work(nCount)", "start.pgx:6: work takes 0 arguments"},
      {"nCount=bAnd(1,2)", "start.pgx:6: no instruction is called bAnd"},
      {"nCount=sioGet(1)", "start.pgx:6: sioGet takes 2 arguments"},
      {"work()", "start.pgx:6: work is a program: call work"},
      {"if diDoor\nendIf", "start.pgx:6: dio where bool is wanted: compare it, diDoor==true"},
      {"bOver=!diDoor", "start.pgx:6: dio where bool is wanted"},
      {"bOver=bOver and diDoor", "start.pgx:6: dio where bool is wanted"},
      {"if nCount\nendIf", "start.pgx:6: num where bool is wanted"},
      {"if true", "start.pgx:7: expected 'endIf' before 'end'"},
      {"endWhile", "expected 'end'"},
      {"nCount=1 nCount=2", "is too much on this line"},
      {"nCount<>1", "VAL3 writes != for <>"},
      {"nCount=nCount.x", "num has no field x"},
      {"kLimit=3", "kLimit is a constant and is written"},
      {"logMsg(\"" + std::string(120, 'a') + "\")", "start.pgx:6: a line of more than 120 characters"},
      {"taskCreate \"second\",10,work()", "stop does not kill the task second"},
      {"taskCreate \"averylongtaskname\",10,work()", "averylongtaskname has more than 15 characters"},
  };
  for (const auto& [code, message] : mistakes) {
    SmallProject project;
    fill(project).program("start",
                          "nCount=0\nbOver=false\ntaskCreateSync \"work\",0.004,bOver,work()\n" + code);
    EXPECT_THAT(problems_of(project), HasSubstr(message)) << code;
  }
}

TEST(Checks, AnArrayIsPassedByReferenceOnly) {
  for (const std::string by : {"", " use=\"value\""}) {
    SmallProject project;
    fill(project).program(
        "put", "x_nTo[0]=1",
        SmallProject::parameters(SmallProject::parameter("x_nTo", "num", "xsi:type=\"array\"" + by)));
    EXPECT_THAT(problems_of(project), HasSubstr("put.pgx")) << by;
  }
}

TEST(Checks, ASynchronousTaskMustNotWait) {
  for (const std::string wait : {"wait(true)", "bOver=watch(true,1)", "waitEndMove()", "popUpMsg(\"a\")"}) {
    SmallProject project;
    fill(project)
        .program("work", "while nCount<kLimit\ncall deep()\ndelay(0)\nendWhile")
        .program("deep", wait);
    EXPECT_THAT(problems_of(project), HasSubstr(" in a synchronous task")) << wait;
  }
}

TEST(Checks, AGlobalThatStartDoesNotSetIsNamed) {
  SmallProject project;
  fill(project).program("start", "bOver=false\ntaskCreateSync \"work\",0.004,bOver,work()");
  EXPECT_THAT(problems_of(project), HasSubstr("nCount is not set by start"));
}

TEST(Checks, WhatNobodyUsesIsNamed) {
  SmallProject project;
  fill(project).number("nIdle").program("lonely", "nCount=1");
  EXPECT_THAT(problems_of(project), HasSubstr("nobody uses nIdle"));
  EXPECT_THAT(problems_of(project), HasSubstr("nobody calls lonely"));
}

TEST(Checks, NamesThatAreTakenOrTooLongAreNamed) {
  SmallProject project;
  fill(project).number("delay").number("aVeryLongVariable");
  EXPECT_THAT(problems_of(project), HasSubstr("delay is a word of the language"));
  EXPECT_THAT(problems_of(project), HasSubstr("aVeryLongVariable has more than 15 characters"));
}

TEST(Files, OfAProjectAreReadStrictly) {
  const std::map<std::string, std::string> mistakes{
      {"<Database></Datas>", "</Datas> closes <Database>"},
      {"<Database a=\"1\" a=\"2\"/>", "attribute a twice"},
      {"<Database>&nbsp;</Database>", "an entity that is none of the five"},
      {"<Database/>", "not a Database of namespace VAL3/Data/2"},
      {"<Database xmlns=\"x\"/><More/>", "more behind the root element"},
      {"<Database xsi:type=\"array\"/>", "xsi:type without xmlns:xsi"},
  };
  for (const auto& [xml, message] : mistakes) {
    SmallProject project;
    fill(project).write();
    project.file("small.dtx", xml);
    std::string all;
    for (const Problem& problem : load(project.path()).problems) all += problem.message() + "\n";
    EXPECT_THAT(all, HasSubstr(message)) << xml;
  }
}

TEST(Files, ThatAreNotListedAreNamed) {
  SmallProject project;
  fill(project).write();
  project.file("more.pgx", "<Programs/>");
  const Loaded loaded = load(project.path());
  ASSERT_EQ(loaded.problems.size(), 1u);
  EXPECT_THAT(loaded.problems[0].text, HasSubstr("more.pgx lies in the folder but is not listed"));
}

TEST(Files, ValuesBelongToTheirType) {
  const std::map<std::string, std::string> values{
      {"<Value key=\"0\" value=\"x\"/>", "value is no number"},
      {"<Value key=\"1\" value=\"1\"/>", "key 1 is beyond its size"},
      {"<Value key=\"0\" j1=\"1\"/>", "attribute j1 does not belong"}};
  for (const auto& [value, message] : values) {
    SmallProject project;
    fill(project).data("kBad", "num", value);
    EXPECT_THAT(problems_of(project), HasSubstr(message));
  }
}

}  // namespace
}  // namespace val3
