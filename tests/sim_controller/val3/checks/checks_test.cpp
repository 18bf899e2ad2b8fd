#include "sim_controller/val3/checks/checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "sim_controller/val3/checks/check_rules.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "tests/sim_controller/val3/checks/checked_cell.hpp"

namespace val3 {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

TEST(Checks, AnApplicationAsItShouldBeHasNoFindings) {
  SmallApplication small = cell();
  small.program("start", "taskCreateSync \"t\",0.004,bLate,task()\ntaskCreate \"u\",10,other()");
  small.program("task", "n=sioCtrl(si,\"timeout\",-1)\nwhile true\nn=sioGet(si,nBytes)\ndelay(0)\nendWhile");
  small.program("other", "while true\nwait(b)\nendWhile");
  EXPECT_THAT(found_in(std::move(small)), IsEmpty());
}

TEST(Checks, AChannelThatWasToldNotToWaitIsNoWaitOfALoop) {
  const std::string create = "\ntaskCreateSync \"t\",0.004,bLate,task()";
  const auto found_with = [&](const std::string& time_out) {
    SmallApplication small = cell();
    small.program("start", time_out + create).program("task", "call inner()");
    small.program("inner", "while true\nn=sioGet(si,nBytes)\nendWhile");
    return found_in(std::move(small));
  };
  EXPECT_THAT(found_with("n=sioCtrl(si,\"timeout\",-1)"), ElementsAre("inner.pgx:2 busy-loop"));
  EXPECT_THAT(found_with("n=sioCtrl(si,\"timeout\",2)"), ElementsAre("inner.pgx:3 sync-blocking"));
  EXPECT_THAT(found_with("n=sioCtrl(si,\"timeout\",-1)\nn=sioCtrl(si,\"timeout\",nOther)"), IsEmpty());
}

TEST(Checks, AnAsynchronousTaskMayAskAChannelInALoop) {
  for (const std::string loop : {"while true\nn=sioGet(si,nBytes)\nendWhile",
                                 "while b\nn=sioGet(si,nBytes)\nif n<0\nclearBuffer(si)\nendIf\nendWhile",
                                 "while b\ncall ask()\nendWhile"}) {
    SmallApplication small = cell();
    small.program("ask", "n=sioGet(si,nBytes)");
    small.program("start", "n=sioCtrl(si,\"timeout\",-1)\n" + loop);
    EXPECT_THAT(found_in(std::move(small)), IsEmpty()) << loop;
  }
}

TEST(Checks, ALoopWhoseConditionAsksAChannelIsEndedByIt) {
  for (const std::string loop : {"while sioGet(si,nBytes)<0\nendWhile", "do\nuntil sioGet(si,nBytes)>0",
                                 "while sioSet(si,nBytes)!=8\nendWhile"}) {
    const std::string quiet = "n=sioCtrl(si,\"timeout\",-1)\n";
    EXPECT_THAT(found_in_start(quiet + loop), IsEmpty()) << loop;
    SmallApplication small = cell();
    small.program("start", quiet + "taskCreateSync \"t\",0.004,bLate,task()").program("task", loop);
    EXPECT_THAT(found_in(std::move(small)), IsEmpty()) << loop;
  }
}

TEST(Checks, WhatWaitsInASynchronousTaskIsFoundAlsoInWhatItCalls) {
  SmallApplication small = cell();
  small.program("start", "taskCreateSync \"t\",0.004,bLate,task()");
  small.program("task", "call inner()\ndelay(0)\nmovel(p,tl,m)");
  small.program("inner", "waitEndMove()\nn=sioGet(si,nBytes)\ns=si\nwait(b)\ndelay(0.5)\ntaskKill(\"u\")");
  EXPECT_THAT(
      found_in(std::move(small)),
      ElementsAre("inner.pgx:2 sync-blocking", "inner.pgx:3 sync-blocking", "inner.pgx:4 sync-blocking",
                  "inner.pgx:5 sync-wait", "inner.pgx:6 sync-wait", "inner.pgx:7 sync-blocking"));
}

TEST(Checks, ATaskThatIsNotSynchronousMayWait) {
  SmallApplication small = cell();
  small.program("start", "taskCreate \"t\",10,task()");
  small.program("task", "waitEndMove()\nn=sioGet(si,nBytes)");
  EXPECT_THAT(found_in(std::move(small)), IsEmpty());
}

TEST(Checks, PeriodsAreMultiplesOf4MsAndTwoAtMost) {
  SmallApplication small = cell();
  small.program("task", "delay(0)");
  small.program(
      "start",
      "taskCreateSync \"a\",0.004,bLate,task()\ntaskCreateSync \"b\",0.02,bLate,task()\ntaskCreateSync "
      "\"c\",0.004,bLate,task()\ntaskCreateSync \"d\",0.01,bLate,task()\ntaskCreateSync "
      "\"e\",0.001,bLate,task()");
  EXPECT_THAT(found_in(small), ElementsAre("start.pgx:5 sync-period", "start.pgx:5 sync-periods",
                                           "start.pgx:6 sync-period", "start.pgx:6 sync-periods"));
  small.application.language = {8, 1, 0};
  EXPECT_THAT(found_in(std::move(small)),
              ElementsAre("start.pgx:5 sync-periods", "start.pgx:6 sync-period", "start.pgx:6 sync-periods"));
}

TEST(Checks, APeriodInAVariableIsLookedAtToo) {
  SmallApplication small = cell();
  small.program("task", "delay(0)");
  small.program("start", "nOther=0.01\ntaskCreateSync \"a\",nOther,bLate,task()");
  EXPECT_THAT(found_in(std::move(small)), ElementsAre("start.pgx:3 sync-period"));
}

TEST(Checks, ADiskInstructionAndTaskResumeMakeASynchronousTaskWait) {
  SmallApplication small = cell();
  small.program("start", "taskCreateSync \"t\",0.004,bLate,task()");
  small.program("task", "n=libSave()\ntaskResume(\"u\",0)\ndelay(0)");
  EXPECT_THAT(found_in(std::move(small)),
              ElementsAre("task.pgx:2 sync-blocking", "task.pgx:3 sync-blocking"));
}

TEST(Checks, ConditionsOfConstantsAreFollowed) {
  EXPECT_THAT(found_in_start("while false\nn=1\nendWhile"), ElementsAre("start.pgx:3 unreachable"));
  EXPECT_THAT(found_in_start("if false\nn=1\nendIf\nn=2"), ElementsAre("start.pgx:3 unreachable"));
  EXPECT_THAT(found_in_start("while 1==1\ndelay(0)\nendWhile\nn=1"), ElementsAre("start.pgx:5 unreachable"));
  EXPECT_THAT(found_in_start("do\nreturn\nuntil b\nn=1"), ElementsAre("start.pgx:5 unreachable"));
  EXPECT_THAT(found_in_start("do\nn=1\nuntil true\nn=1"), IsEmpty());
}

/// What a rule tells of a program of the cell on a controller of this version.
std::vector<Severity> severities_of(std::string_view rule, const std::string& code, const Version& version) {
  SmallApplication small = cell();
  small.program("start", code);
  Findings findings;
  resolve(small.application, findings);
  check(small.application, {version}, findings);
  std::vector<Severity> told;
  for (const Finding& one : findings)
    if (one.rule == rule) told.push_back(one.severity);
  return told;
}

TEST(Checks, APrintByAQuestionMarkIsOnlyNotedFromS7OnWhereProgramsHaveIt) {
  const auto severities = [](const Version& version) {
    return severities_of(check_rules::kNewerForm, "?\"text\"", version);
  };
  EXPECT_THAT(severities({6, 8, 0}), ElementsAre(Severity::kError));
  EXPECT_THAT(severities({7, 2, 0}), ElementsAre(Severity::kNote));
  EXPECT_THAT(severities({8, 0, 0}), IsEmpty());
}

TEST(Checks, FormsOfALaterVersionAreFound) {
  const auto found_with = [](std::string_view code, Version version) {
    return found_in(cell().program("start", code), {version});
  };
  EXPECT_THAT(found_with("?\"text\"", {7, 7, 2}), ElementsAre("start.pgx:2 newer-form"));
  EXPECT_THAT(found_with("n=sioCtrl(si,\"timeout\",-1)", {6, 4, 0}), ElementsAre("start.pgx:2 newer-form"));
  EXPECT_THAT(found_with("n=sioCtrl(si,\"nagle\",false)", {6, 4, 0}), ElementsAre("start.pgx:2 newer-form"));
  EXPECT_THAT(found_with("n=sioCtrl(si,\"timeout\",-1)", {7, 7, 2}), IsEmpty());
}

TEST(Checks, ALoopThatWaitsForNothingIsFound) {
  for (const std::string_view loop :
       {"while true\nn=1\nendWhile", "while b==false\nn=1\nendWhile", "while !isSettled()\nendWhile",
        "do\nn=1\nuntil clock()>5", "while nOther>1\ncall other()\nendWhile", "while d==true\nendWhile"}) {
    SmallApplication small = cell();
    small.program("other", "n=1");
    small.program("start", loop);
    EXPECT_THAT(found_in(std::move(small)), ElementsAre("start.pgx:2 busy-loop")) << loop;
  }
}

TEST(Checks, ALoopThatEndsOrWaitsIsNone) {
  for (const std::string_view loop :
       {"while true\ndelay(0)\nendWhile", "while n<5\nn=n+1\nendWhile", "do\ncall add(n)\nuntil n>5",
        "while watch(b,1)==false\nendWhile", "while nOther>1\ncall other()\nendWhile",
        "while b\ncall waits()\nendWhile", "while true\nif b\nreturn\nendIf\nendWhile",
        "while b\nn=sioGet(si,nBytes)\nendWhile", "for n=1 to 5\nendFor"}) {
    SmallApplication small = cell();
    small.program("add", "x_n=x_n+1", {small.reference("num", "x_n")});
    small.program("other", "call another()").program("another", "nOther=0").program("waits", "wait(b)");
    small.program("start", loop);
    EXPECT_THAT(found_in(std::move(small)), IsEmpty()) << loop;
  }
}

TEST(Checks, LinesBehindAReturnOrAnEndlessLoopAreNeverReached) {
  EXPECT_THAT(found_in_start("return\nn=1\nn=2"), ElementsAre("start.pgx:3 unreachable"));
  EXPECT_THAT(found_in_start("while true\ndelay(0)\nendWhile\nn=1"), ElementsAre("start.pgx:5 unreachable"));
  EXPECT_THAT(found_in_start("if b\nreturn\nelse\nreturn\nendIf\nn=1"),
              ElementsAre("start.pgx:7 unreachable"));
  EXPECT_THAT(found_in_start("if b\nreturn\nn=1\nendIf\nn=1"), ElementsAre("start.pgx:4 unreachable"));
  EXPECT_THAT(found_in_start("switch n\ncase 1\nreturn\nbreak\ndefault\nreturn\nbreak\nendSwitch\nn=1"),
              ElementsAre("start.pgx:10 unreachable"));
}

TEST(Checks, WhatIsReachedInSomeWayIsReached) {
  for (const std::string_view code :
       {"if b\nreturn\nendIf\nn=1", "if b\nreturn\nelseIf n>1\nn=2\nelse\nreturn\nendIf\nn=1",
        "switch n\ncase 1\nreturn\nbreak\nendSwitch\nn=1",
        "switch n\ncase 1\nreturn\nbreak\ndefault\nbreak\nendSwitch\nn=1",
        "for n=1 to 3\nreturn\nendFor\nn=1", "do\nn=n+1\nuntil n>3\nn=1", "return"})
    EXPECT_THAT(found_in_start(code), IsEmpty()) << code;
}

TEST(Checks, ALocalThatIsReadBeforeItIsSetIsFoundOnce) {
  const auto found = [](std::string_view code) {
    SmallApplication small = cell();
    small.program("set", "x_n=1", {small.reference("num", "x_n")});
    small.program("start", code, {}, {{"num", "l_n"}});
    return found_in(std::move(small));
  };
  EXPECT_THAT(found("n=l_n\nn=l_n"), ElementsAre("start.pgx:2 local-never-set"));
  EXPECT_THAT(found("n=l_n\nl_n=1"), ElementsAre("start.pgx:2 local-never-set"));
  EXPECT_THAT(found("l_n=l_n+1"), ElementsAre("start.pgx:2 local-never-set"));
  EXPECT_THAT(found("l_n=1\nn=l_n"), IsEmpty());
  EXPECT_THAT(found("call set(l_n)\nn=l_n"), IsEmpty());
  EXPECT_THAT(found("if b\nl_n=1\nendIf\nn=l_n"), IsEmpty());
  EXPECT_THAT(found("while b\nif bLate\nn=l_n\nendIf\nl_n=1\ndelay(0)\nendWhile"), IsEmpty());
  EXPECT_THAT(found("s=toNum(s,l_n,b)\nn=l_n"), IsEmpty());
  EXPECT_THAT(found("for l_n=1 to 3\nn=l_n\nendFor"), IsEmpty());
  EXPECT_THAT(found("n=size(l_n)"), IsEmpty());
}

TEST(Checks, AVariableWithoutValueThatNothingSetsIsFound) {
  SmallApplication small = cell();
  small.global("num", "nNever")
      .global("num", "nSet")
      .global("num", "nPublic", {1}, true)
      .global("dio", "dFree");
  small.global("dio", "dLinked");
  small.program("start", "n=nNever+nSet+nPublic\nnSet=1\nd=dFree\ndioLink(dLinked,d)\nd=dLinked");
  EXPECT_THAT(found_in(std::move(small)),
              ElementsAre("small.dtx:1 global-never-set", "small.dtx:1 never-linked"));
}

TEST(Checks, WhatIsNeverUsedIsANote) {
  SmallApplication small;
  small.global("num", "nIdle").global("num", "nUsed").global("frame", "fFather");
  small.application.globals.back().values.push_back(stored("x", "1"));
  small.global("pointRx", "p");
  small.application.globals.back().values.push_back(stored("fatherId", "fFather[0]"));
  small.program("start", "nUsed=1\np=p\ncall used(1)", {}, {{"num", "l_idle"}});
  small.program("used", "nUsed=2", {small.value("num", "x_idle")}).program("idle", "call used(1)");
  small.application.programs.back().is_public = false;
  Findings findings;
  resolve(small.application, findings);
  check(small.application, {}, findings);
  for (const Finding& one : findings) EXPECT_EQ(one.severity, Severity::kNote) << in_short(one);
  EXPECT_THAT(in_short(findings), ElementsAre("idle.pgx:1 unused-program", "small.dtx:1 unused-variable",
                                              "small.dtx:1 unused-variable", "used.pgx:1 unused-parameter"));
}

TEST(Checks, ASocketThatIsUsedAndNeverClosedIsFound) {
  const auto found = [](std::string_view stop) {
    SmallApplication small = cell();
    small.application.programs.clear();
    small.program("shut", "clearBuffer(x_si)", {small.value("sio", "x_si")});
    small.program("start", "n=sioSet(si,nBytes)").program("stop", stop);
    return found_in(std::move(small));
  };
  EXPECT_THAT(found("n=1"), ElementsAre("start.pgx:2 socket-never-closed"));
  EXPECT_THAT(found("clearBuffer(si)"), IsEmpty());
  EXPECT_THAT(found("call shut(si)"), IsEmpty());
}

TEST(Checks, TrapsOfTheManualsAreNotes) {
  EXPECT_THAT(found_in_start("b=!(j>j)"), ElementsAre("start.pgx:2 joint-comparison"));
  EXPECT_THAT(found_in_start("b=cos(90)==0"), ElementsAre("start.pgx:2 exact-comparison"));
  EXPECT_THAT(found_in_start("n=sioCtrl(si,\"timeout\",0)"), ElementsAre("start.pgx:2 timeout-zero"));
  EXPECT_THAT(found_in_start("b=j>j\nb=n==0\nn=sioCtrl(si,\"timeout\",1)"), IsEmpty());
}

TEST(Checks, AMoveTowardsAContactThatBlendsIsANote) {
  EXPECT_THAT(found_in_start("setLatch(d)\nmovel(p,tl,m)"), ElementsAre("start.pgx:3 blend"));
  EXPECT_THAT(found_in_start("m.blend=off\nsetLatch(d)\nmovel(p,tl,m)"), IsEmpty());
  EXPECT_THAT(found_in_start("movel(p,tl,m)"), IsEmpty());
}

TEST(Checks, AnOlderVersionLacksWhatCameLater) {
  const auto found = [](std::string_view code, const Version& version) {
    SmallApplication small = cell();
    small.program("start", code);
    return found_in(std::move(small), {version});
  };
  EXPECT_THAT(found("n=power(n,2)\nn=getMonitorSpeed()", {5, 3, 0}),
              ElementsAre("start.pgx:2 newer-instruction", "start.pgx:3 newer-instruction"));
  EXPECT_THAT(found("n=getMonitorSpeed()", {6, 4, 0}), IsEmpty());
  EXPECT_THAT(found("if b\nelseIf b\nendIf", {6, 2, 0}), ElementsAre("start.pgx:3 newer-form"));
  EXPECT_THAT(found("switch s\ncase \"x\",\"y\"\nbreak\nendSwitch", {6, 2, 0}),
              ElementsAre("start.pgx:2 newer-form", "start.pgx:3 newer-form"));
  EXPECT_THAT(found("n=movej(j,tl,m)", {6, 8, 0}), ElementsAre("start.pgx:2 newer-form"));
  EXPECT_THAT(found("n=size(nBytes,1)", {6, 8, 0}), ElementsAre("start.pgx:2 newer-instruction"));
  EXPECT_THAT(found("n=speedScale()", {6, 8, 0}), ElementsAre("start.pgx:2 older-instruction"));
  EXPECT_THAT(found("n=size(nBytes,1)\nn=movej(j,tl,m)\nif b\nelseIf b\nendIf", {7, 7, 2}), IsEmpty());
}

TEST(Checks, WhatCameBetweenTheLastManualAndS7IsAWarning) {
  const auto severities = [](const Version& version) {
    return severities_of(
        check_rules::kNewerInstruction,
        "append(nBytes)\nresize(nBytes,1,9)\ninsert(nBytes[1])\ndelete(nBytes[1])\nn=size(nBytes,1)",
        version);
  };
  EXPECT_EQ(severities({6, 4, 99}), std::vector(5, Severity::kError));
  EXPECT_EQ(severities({6, 8, 0}), std::vector(5, Severity::kWarning));
  EXPECT_THAT(severities({7, 0, 0}), IsEmpty());
}

TEST(Checks, AnOlderVersionLacksCollectionsAndLongNames) {
  SmallApplication small = cell();
  small.global("num", "nMap", {}).global("num", "nTable", {2, 3}).global("num", "nOfMoreThan15Letters");
  for (std::size_t i = small.application.globals.size() - 3; i < small.application.globals.size(); ++i)
    small.application.globals[i].values.push_back(stored("value", "1"));
  small.program("start", "nMap[s]=nTable[0,0]+nOfMoreThan15Letters");
  EXPECT_THAT(found_in(small, {Version{6, 8, 0}}),
              ElementsAre("small.dtx:1 newer-form", "small.dtx:1 newer-form", "small.dtx:1 newer-name"));
  EXPECT_THAT(found_in(small, {Version{7, 7, 0}}), ElementsAre("small.dtx:1 newer-name"));
  EXPECT_THAT(found_in(std::move(small), {Version{8, 1, 0}}), IsEmpty());
}

TEST(Checks, FindingsAreInOrderAndToldOnce) {
  Findings findings;
  for (const auto& [file, line] :
       std::vector<std::pair<std::string, int>>{{"b.pgx", 1}, {"a.pgx", 20}, {"a.pgx", 3}, {"b.pgx", 1}})
    findings.push_back({Severity::kNote, "rule", {file, line, 1}, "what", ""});
  sort_findings(findings);
  EXPECT_THAT(in_short(findings), ElementsAre("a.pgx:3 rule", "a.pgx:20 rule", "b.pgx:1 rule"));
}

TEST(Checks, ASocketThatIsOnlySetUpIsNotUsed) {
  SmallApplication small = cell();
  small.application.programs.clear();
  small.program("start", "n=sioCtrl(si,\"port\",5000)\nn=ioStatus(si)").program("stop", "n=1");
  EXPECT_THAT(found_in(std::move(small)), IsEmpty());
}

/// Words of the language in any order: most lines are wrong, and some are right.
std::string any_program(std::mt19937& chance) {
  constexpr std::array kWords{
      "n",       "b",      "s",         "d",      "j",      "p",           "m",
      "si",      "nBytes", "l_n",       "x_n",    "q",      "1",           "2.5",
      "\"t\"",   "true",   "=",         "==",     "+",      "-",           "*",
      "!",       "<",      "(",         ")",      "[",      "]",           "{",
      "}",       ",",      ".",         ":",      "x",      "trsf",        "lib",
      "io",      "if ",    "elseIf ",   "else",   "endIf",  "while ",      "endWhile",
      "do",      "until ", "for ",      " to ",   "endFor", "switch ",     "case ",
      "default", "break",  "endSwitch", "call ",  "return", "start",       "other",
      "sioGet",  "movej",  "abs",       "toNum",  "size",   "delay",       "first",
      " and ",   " or ",   "world",     "flange", "off",    "taskCreate ", "taskCreateSync ",
      "\n",      "\n"};
  std::uniform_int_distribution<std::size_t> word(0, kWords.size() - 1);
  std::string code;
  for (int i = 0; i < 80; ++i) code += kWords[word(chance)];
  return code;
}

TEST(Checks, AnyProgramIsResolvedAndCheckedToItsEnd) {
  constexpr unsigned kSeed = 17;
  std::mt19937 chance(kSeed);
  std::size_t found = 0;
  for (int i = 0; i < 3000; ++i) {
    SmallApplication small = cell();
    small.library("lib", nullptr).program("start", any_program(chance));
    small.program("other", any_program(chance), {small.reference("num", "x_n", 1)}, {{"num", "l_n"}});
    found += found_in(std::move(small)).size();
  }
  EXPECT_GT(found, 3000U);
}

TEST(Checks, BrokenProgramsAreCheckedToo) {
  for (const std::string_view code :
       {"while", "endWhile\nif b", "switch n\nn=1\nendSwitch", "case 1\nbreak", "do\ndo\nuntil b",
        "taskCreateSync", "taskCreateSync \"t\",0.004", "call", "for n=1\nendFor",
        "n=", "until true\nwhile true\nreturn\nendIf"}) {
    EXPECT_THAT(found_in_start(code), Not(IsEmpty())) << code;
  }
}

}  // namespace
}  // namespace val3
