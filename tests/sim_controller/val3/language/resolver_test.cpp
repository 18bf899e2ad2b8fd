#include "sim_controller/val3/language/resolver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/val3/files/built_in_io.hpp"
#include "tests/sim_controller/val3/small_application.hpp"

namespace val3 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// One global of every kind, and a program to call.
SmallApplication everything() {
  SmallApplication small;
  for (const auto& [type, name] :
       std::vector<std::pair<std::string_view, std::string_view>>{{"num", "n"},
                                                                  {"bool", "b"},
                                                                  {"string", "s"},
                                                                  {"dio", "d"},
                                                                  {"aio", "a"},
                                                                  {"sio", "si"},
                                                                  {"trsf", "t"},
                                                                  {"frame", "f"},
                                                                  {"tool", "tl"},
                                                                  {"mdesc", "m"},
                                                                  {"jointRx", "j"},
                                                                  {"pointRx", "p"},
                                                                  {"configRx", "cf"},
                                                                  {"screen", "scr"},
                                                                  {"jointRs", "jRs"}})
    small.global(type, name);
  small.global("num", "nArray", {10}).global("num", "nTable", {3, 4}).global("num", "nMap", {});
  small.global("string", "sArray", {4});
  small.program(
      "other", "n=1",
      {small.value("num", "x_n"), small.reference("bool", "x_b"), small.reference("num", "x_a", 1)});
  return small;
}

std::vector<std::string> refused_in(SmallApplication small) {
  EXPECT_THAT(in_short(small.findings), IsEmpty());
  Findings findings;
  resolve(small.application, findings);
  return in_short(findings);
}
/// Rules of what is found in one line.
std::vector<std::string> refused_in(const std::string& line) {
  SmallApplication small = everything();
  small.program("start", line);
  std::vector<std::string> rules;
  for (const std::string& one : refused_in(std::move(small))) rules.push_back(one.substr(one.find(' ') + 1));
  return rules;
}

TEST(Resolver, WhatAControllerTakesIsTaken) {
  for (const std::string line : {
           "n=1+2*3",
           "n=nArray[n+1]",
           "n=nTable[1,2]",
           "n=nMap[\"key\"]",
           "nMap[s+\"x\"]=1",
           "s=\"a\"+toString(\".3\",n)",
           "b=d",
           "d=b",
           "d=d",
           "b=d==true",
           "b=(d==d) and b",
           "b=n>1 or !b",
           "b=d!=b",
           "d=!d",
           "n=a",
           "a=1.5",
           "b=a>2",
           "si=\"text\"",
           "si=65",
           "n=si",
           "s=si",
           "j={0,0,0,0,0,0}",
           "b=herej()=={0,0,0,0,0,0}",
           "j=herej()-j",
           "b=herej()>{1,1,1,1,1,1}",
           "p={{1,2,3,0,0,0},{sfree,efree,wfree}}",
           "p.config={ssame,esame,wsame}",
           "p.config.shoulder=lefty",
           "t=!t*{0,0,1,0,0,0}",
           "b=p.trsf!={0,0,0,0,0,0}",
           "m.blend=off",
           "m.blend=joint",
           "m.blend=Cartesian",
           "n=p.trsf.x",
           "tl.gripper=d",
           "p=appro(p,{0,0,-100,0,0,0})",
           "movej(p,tl,m)",
           "movej({0,0,0,0,0,0},flange,m)",
           "n=movel(p,tl,m)",
           "p=here(flange,world)",
           "b=here(flange,world).trsf.x>1",
           "n=sioGet(si,nArray)",
           "n=sioSet(si,nArray[3])",
           "n=sioCtrl(si,\"nagle\",false)",
           "n=m.vel=m.accel=50",
           "s=toNum(s,n,b)",
           "n=size(nArray)",
           "n=size(nTable,2)",
           "s=next(nMap[s])",
           "wait(d==true)",
           "n=sel(d,1,2)",
           "put(n)",
           "put(scr,\"text\")",
           "call other(1,b,nArray[2])",
           "call other(a,b,nArray)",
           "taskCreate \"t\",10,other(n,b,nArray)",
           "taskCreateSync \"t\",0.004,b,other(n,b,nArray)",
           "for n=1 to 3 step 2\nendFor",
           "for nArray[1]=1 to 3\nendFor",
           "switch n\ncase 1,n+1\nbreak\ndefault\nbreak\nendSwitch",
           "switch s\ncase \"x\"\nbreak\nendSwitch",
           "while b or d==true\nendWhile",
           "n=libSave()",
           "jRs=abs(jRs)",
           "nArray[0]=nArray[1]",
       })
    EXPECT_THAT(refused_in(line), IsEmpty()) << line;
}

TEST(Resolver, WhatAControllerRefusesIsFoundOnce) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"n=x", "undefined-name"},
      {"n=N", "undefined-name"},
      {"n=other", "undefined-name"},
      {"n=clock", "undefined-name"},
      {"n=lib:x", "undefined-library"},
      {"n=lib:libLoad(\"x\")", "undefined-library"},
      {"call lib:x()", "undefined-library"},
      {"call nothing()", "undefined-program"},
      {"nothing()", "undefined-instruction"},
      {"n=1+nothing(n)*2", "undefined-instruction"},
      {"other(1,b,n)", "program-without-call"},
      {"n=p.x", "undefined-field"},
      {"n=n.x", "undefined-field"},
      {"n=\"text\"", "wrong-type"},
      {"n=b", "wrong-type"},
      {"b=n", "wrong-type"},
      {"p=t", "wrong-type"},
      {"n=cls()", "wrong-type"},
      {"s=\"a\"+n", "operator-type"},
      {"n=s-s", "operator-type"},
      {"b=b+b", "operator-type"},
      {"b=t<t", "operator-type"},
      {"b=si==si", "operator-type"},
      {"b=s==n", "operator-type"},
      {"n=-s", "operator-type"},
      {"b={1,2}=={1,2}", "braces"},
      {"t={0,0,1,0,0,0}*{0,0,1,0,0,0}", "braces"},
      {"j={1,2,3,4,5,6}-{1,2,3,4,5,6}", "braces"},
      {"t=!{0,0,1,0,0,0}", "braces"},
      {"j=-{1,2,3,4,5,6}", "braces"},
      {"n=cls()+1", "wrong-type"},
      {"n=-cls()", "wrong-type"},
      {"b=1==cls()", "wrong-type"},
      {"b=cls() or b", "wrong-type"},
      {"n=nArray[cls()]", "wrong-type"},
      {"n=sin(cls())", "wrong-type"},
      {"if n\nendIf", "condition-type"},
      {"b=n and b", "condition-type"},
      {"b=!n", "condition-type"},
      {"if d\nendIf", "dio-condition"},
      {"b=b or d", "dio-condition"},
      {"wait(d)", "dio-condition"},
      {"n=sin()", "missing-argument"},
      {"n=sin(1,2)", "extra-argument"},
      {"n=sin(s)", "wrong-type"},
      {"movel(j,tl,m)", "wrong-type"},
      {"n=sioGet(si,sArray)", "wrong-type"},
      {"s=toNum(s,5,b)", "not-a-variable"},
      {"call other(1,b)", "missing-argument"},
      {"call other(1,b,n,n)", "extra-argument"},
      {"call other(s,b,nArray)", "wrong-type"},
      {"call other(1,d,nArray)", "wrong-type"},
      {"call other(1,true,nArray)", "constant-by-reference"},
      {"call other(1,b,nTable)", "array-dimensions"},
      {"n=nTable[1]", "index-count"},
      {"n=nArray[1,2]", "index-count"},
      {"n=nArray[s]", "index-type"},
      {"n=nMap[1]", "index-type"},
      {"n=nMap[s,s]", "index-count"},
      {"n=herej()[1]", "index-not-allowed"},
      {"n=p.trsf.x[1]", "index-not-allowed"},
      {"j={1,2,3,4,5,6,7}", "braces"},
      {"n={1}", "braces"},
      {"j={1,s,3,4,5,6}", "wrong-type"},
      {"movej({1,2,3,4,5,6,7},tl,m)", "braces"},
      {"for s=1 to 2\nendFor", "wrong-type"},
      {"for n=s to 2\nendFor", "wrong-type"},
      {"off=joint", "not-a-variable"},
      {"switch n\ncase s\nbreak\nendSwitch", "case-type"},
      {"taskCreate n,10,other(n,b,nArray)", "wrong-type"},
      {"taskCreate \"t\",0,other(n,b,nArray)", "task-priority"},
      {"taskCreate \"a b\",10,other(n,b,nArray)", "task-name"},
      {"taskCreate \"abcdefghijklmnop\",10,other(n,b,nArray)", "task-name"},
      {"taskCreateSync \"t\",0.004,n,other(n,b,nArray)", "wrong-type"},
  };
  for (const auto& [line, rule] : cases) EXPECT_THAT(refused_in(line), ElementsAre(rule)) << line;
}

TEST(Resolver, NamesStandForLocalsThenParametersThenGlobals) {
  SmallApplication small = everything();
  small.program("start", "n=1\ns=n\nb=m", {small.value("bool", "m")}, {{"string", "n"}});
  Findings findings;
  resolve(small.application, findings);
  EXPECT_THAT(in_short(findings), ElementsAre("start.pgx:2 wrong-type"));
  const Program& start = small.application.programs.back();
  EXPECT_EQ(start.lines[1].expressions[1].reference.to, Reference::To::kLocal);
  EXPECT_EQ(start.lines[2].expressions[1].reference.to, Reference::To::kParameter);
  EXPECT_EQ(start.lines[2].expressions[0].reference.to, Reference::To::kGlobal);
  EXPECT_EQ(start.lines[2].expressions[0].reference.index, 1);
}

TEST(Resolver, WordsHaveTheirPlaceInTheirList) {
  SmallApplication small = everything();
  small.program("start", "m.blend=Cartesian\np.config.wrist=wsame");
  Findings findings;
  resolve(small.application, findings);
  const auto& lines = small.application.programs.back().lines;
  EXPECT_EQ(lines[0].expressions[1].reference.to, Reference::To::kWord);
  EXPECT_EQ(lines[0].expressions[1].reference.index, 2);
  EXPECT_EQ(lines[1].expressions[1].reference.index, 2);
  EXPECT_EQ(lines[1].expressions[0].type.kind, Kind::kWrist);
}

TEST(Resolver, ValuesInBracesGetTheirTypeFromWhereTheyStand) {
  SmallApplication small = everything();
  small.program("start", "p={{1,2,3,0,0,0},{sfree,efree,wfree}}\nmovej({1,2,3,4,5,6},tl,m)");
  Findings findings;
  resolve(small.application, findings);
  const auto& lines = small.application.programs.back().lines;
  EXPECT_EQ(lines[0].expressions[1].type.kind, Kind::kPoint);
  EXPECT_EQ(lines[0].expressions[1].parts[0].type.kind, Kind::kTrsf);
  EXPECT_EQ(lines[1].expressions[0].parts[0].type.kind, Kind::kJoint);
}

TEST(Resolver, ACallKnowsItsInstructionAndItsSignature) {
  SmallApplication small = everything();
  small.program("start", "j=abs(j)");
  Findings findings;
  resolve(small.application, findings);
  const Expression& call = small.application.programs.back().lines[0].expressions[1];
  ASSERT_EQ(call.reference.to, Reference::To::kInstruction);
  EXPECT_EQ(call.reference.index, 1);
  EXPECT_EQ(call.type.kind, Kind::kJoint);
}

TEST(Resolver, ATaskTakesNoReferenceToALocal) {
  SmallApplication small = everything();
  small.program("start",
                "taskCreate \"t\",10,other(l_n,b,l_n)\ntaskCreateSync \"u\",0.004,l_b,other(1,b,nArray)", {},
                {{"num", "l_n"}, {"bool", "l_b"}});
  EXPECT_THAT(refused_in(std::move(small)),
              ElementsAre("start.pgx:2 local-to-task", "start.pgx:3 local-to-task"));
}

TEST(Resolver, AnElementHasNoOthers) {
  SmallApplication small = everything();
  small.program("start", "x_a[n]=1\nx_e[0]=1\nx_e[n]=1",
                {small.reference("num", "x_a", 1), small.reference("num", "x_e")});
  EXPECT_THAT(refused_in(std::move(small)), ElementsAre("start.pgx:4 element-index"));
}

TEST(Resolver, FieldsOfAUserTypeAreItsPublicData) {
  SmallApplication small = everything();
  UserType inner{"tInner", {{small.declared("num", "nSeq", {1}), true, {}}}, {}};
  small.application.user_types.push_back(inner);
  UserType outer{
      "tOuter",
      {{small.declared("tInner", "buffer", {5}), true, {}}, {small.declared("num", "nCount", {1}), true, {}}},
      {}};
  small.application.user_types.push_back(outer);
  small.global("tOuter", "q");
  small.program("start",
                "n=q.buffer[n].nSeq\nq.buffer[1]=q.buffer[2]\nn=q.buffer[1].nNone\nn=q\nn=q.nCount[0]");
  EXPECT_THAT(refused_in(std::move(small)),
              ElementsAre("start.pgx:4 undefined-field", "start.pgx:5 wrong-type"));
}

TEST(Resolver, ATypeOfWhichACopyLiesInAnotherFolderIsOneType) {
  SmallApplication small = everything();
  const auto point = [&](std::string_view field, const char* project) {
    return UserType{"tPlace", {{small.declared("num", field, {1}), true, {}}}, {}, project};
  };
  small.application.user_types = {point("nX", "a/tPlace.pjx"), point("nX", "b/tPlace.pjx"),
                                  point("nY", "c/tPlace.pjx")};
  for (int type = 0; type < 3; ++type) {
    small.global("num", "place" + std::to_string(type));
    small.application.globals.back().declared.type = {Kind::kUser, type};
  }
  small.program("start", "place0=place1\nplace0=place2");
  EXPECT_THAT(refused_in(std::move(small)), ElementsAre("start.pgx:3 wrong-type"));
}

TEST(Resolver, AVariableOfAScaraIsTakenAsItComes) {
  SmallApplication small = everything();
  small.program("start", "jRs=herej()\nmovej(jRs,tl,m)\njRs=jRs-jRs\nn=jRs.j1");
  EXPECT_THAT(refused_in(std::move(small)), IsEmpty());
}

TEST(Resolver, AProgramMayHaveAnInstructionsName) {
  SmallApplication small = everything();
  small.program("stopMove", "stopMove()\ncall stopMove()");
  EXPECT_THAT(refused_in(std::move(small)), IsEmpty());
}

TEST(Resolver, ALibraryGivesItsPublicNames) {
  SmallApplication there;
  UserType message{"tMessage", {{there.declared("num", "nSize", {1}), true, {}}}, {}};
  there.application.user_types.push_back(message);
  there.global("num", "nOpen", {1}, true).global("num", "nHidden").global("tMessage", "last", {1}, true);
  there.program("send", "nOpen=1", {there.reference("tMessage", "x_message")});
  SmallApplication small = everything();
  small.library("lib", std::make_shared<Application>(std::move(there.application)));
  small.program(
      "start",
      "n=lib:nOpen\nn=lib:nHidden\nn=lib:nNone\nn=lib:last.nSize\ncall lib:send(lib:last)\ncall "
      "lib:none()\ns=lib:libPath()\nb=lib:libExist(\"send()\")\ntaskCreate \"t\",1,lib:send(lib:last)");
  Findings findings;
  resolve(small.application, findings);
  EXPECT_THAT(in_short(findings), ElementsAre("start.pgx:3 not-public", "start.pgx:4 undefined-name",
                                              "start.pgx:7 undefined-program"));
  // the type has come with it
  EXPECT_EQ(small.application.user_type_named("tMessage"), 0);
  const Line& call = small.application.programs.back().lines[4];
  EXPECT_EQ(call.called_library, 0);
  EXPECT_EQ(call.called_program, 0);
}

TEST(Resolver, ALibraryThatIsNotThereRaisesNoFurtherFinding) {
  SmallApplication small = everything();
  small.library("lib", nullptr);
  small.program(
      "start",
      "n=lib:x+1\ns=lib:x[3].y.z\nif lib:b and b\nendIf\ncall lib:go(n,1)\nlib:x=5\nj=abs(lib:x)\nn=sin("
      "lib:x)\nfor lib:n=1 to 3\nendFor\ncall other(lib:n,lib:b,lib:a)\ns=\"a\"+lib:s\nput(lib:s)");
  EXPECT_THAT(refused_in(std::move(small)), IsEmpty());
}

TEST(Resolver, OldControllersHaveTheirSignalsInTheLibraryIo) {
  SmallApplication small = everything();
  small.application.form = 5;
  small.library("io", built_in_io(small.application));
  small.program(
      "start",
      "b=io:bIn3\nio:bOut0=true\nn=io:CPU_TEMP\nif io:fIn0\nendIf\nn=io:mine\nif io:usrIn0==true\nendIf");
  EXPECT_THAT(refused_in(std::move(small)),
              ElementsAre("start.pgx:5 dio-condition", "start.pgx:7 unknown-signal"));
}

TEST(Resolver, ArgumentsThatNoSourceTellsAreNotChecked) {
  for (const std::string line :
       {"$movejSync({0,0,0,0,0,0},tl,m,n,s)", "n=$movejSync()", "setPayload(1,t,s,b)"})
    EXPECT_THAT(refused_in(line), IsEmpty()) << line;
  EXPECT_THAT(refused_in("$movejSync({1,2}*{1,2},tl,m)"), ElementsAre("braces"));
  EXPECT_THAT(refused_in("setPayload(x)"), ElementsAre("undefined-name"));
}

TEST(Resolver, AVariableThatIsWantedAndNotThereIsNamedSo) {
  SmallApplication small = everything();
  small.program("start", "userPageAlert(s,{1,2})");
  Findings findings;
  resolve(small.application, findings);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].what, "argument 2 of userPageAlert() is a variable, and this is 2 values in braces");
}

TEST(Resolver, AnInstructionOfAnAddOnIsANoteAndOfS8AWarning) {
  SmallApplication small = everything();
  small.program("start", "n=$unheard(n)+1");
  Findings findings;
  resolve(small.application, findings);
  ASSERT_THAT(in_short(findings), ElementsAre("start.pgx:2 unknown-addon"));
  EXPECT_EQ(findings[0].severity, Severity::kNote);

  SmallApplication newer = everything();
  newer.application.language = {8, 1, 0};
  newer.program("start", "n=unheard(n)+1");
  findings.clear();
  resolve(newer.application, findings);
  ASSERT_THAT(in_short(findings), ElementsAre("start.pgx:2 undefined-instruction"));
  EXPECT_EQ(findings[0].severity, Severity::kWarning);
}

}  // namespace
}  // namespace val3
