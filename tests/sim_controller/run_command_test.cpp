#include "sim_controller/run_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/run_script.hpp"
#include "tests/sim_controller/small_run.hpp"
#include "tests/sim_controller/val3/files/old_project.hpp"
#include "tests/val3/small_project.hpp"

namespace sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using testing::run_small;
using testing::SmallRun;

TEST(RunCommand, DrivesInputsPowerKeysAndSocketsByTheScript) {
  val3::SmallProject project;
  project.number("n", 3).number("in", 4).number("out", 2).flag("b");
  project.data("di", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I0\"/>");
  project.data("dq", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%Q0\"/>");
  project.data("si", "sio", "<Value key=\"0\" link=\"Socket\\host\"/>");
  project.data("j", "jointRx", "<Value key=\"0\" j1=\"5\" j2=\"10\" j3=\"90\" j5=\"60\"/>")
      .data("m", "mdesc", "");
  project.program("start",
                  "userPage()\ntitle(\"small\")\nputln(\"hello\")\nwait(di==true)\ndq=true\nn[0]=getKey()\n"
                  "n[1]=sioGet(si,in)\nout[0]=in[0]+1\nout[1]=in[1]+1\nsioSet(si,out)\n"
                  "wait(isPowered())\nmovej(j,flange,m)\nwaitEndMove()\nlogMsg(\"done\")");
  const SmallRun ran =
      run_small(project.write().path(),
                "0 power off\n0.1 expect-output BasicIO-1\\%Q0 off\n0.2 key 271\n"
                "0.2 input BasicIO-1\\%I0 on\n0.3 expect-output BasicIO-1\\%Q0 on\n"
                "0.3 expect-number n 271\n0.4 connect Socket\\host\n0.4 send Socket\\host \"AB\"\n"
                "0.5 expect-sent Socket\\host \"BC\"\n0.5 expect-task small~ 1\n0.6 power on\n60 end\n");
  EXPECT_EQ(ran.code, kRanWell) << ran.out << ran.error;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("log: done"), HasSubstr("page: small"), HasSubstr("hello"),
                             HasSubstr("the application has ended"), HasSubstr("0 failures")));
}

TEST(RunCommand, TellsADeadTaskWithItsErrorAndLine) {
  val3::SmallProject project;
  project.number("n", 2).program("start", "n=1\nn=n[7]");
  const SmallRun ran = run_small(project.write().path(), "");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.out, HasSubstr("FAILED task small~ ends with error 20 at start.pgx:4"));
}

TEST(RunCommand, TellsAPeriodThatWasTooShort) {
  val3::SmallProject project;
  project.number("n").flag("bLate").program("busy", "while true\nn=n+1\nendWhile");
  project.program("start", "taskCreateSync \"busy\",0.004,bLate,busy()");
  const SmallRun ran = run_small(project.write().path(), "", 0.1);
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.out, HasSubstr("task busy did not end within its period"));
}

TEST(RunCommand, TellsWhatWasExpectedAndIsNot) {
  val3::SmallProject project;
  project.number("n").program("start", "n=4\ndelay(10)");
  const SmallRun ran = run_small(project.write().path(),
                                 "0.1 expect-number n 4\n0.2 expect-number n 5\n0.3 expect-number none 1\n"
                                 "0.3 expect-number n[9] 1\n0.3 send Socket\\x \"a\"\n0.4 stop\n1 end\n");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("FAILED line 2: n: it is 4"), HasSubstr("line 3: none: the application"),
                    HasSubstr("line 4: n[9]"), HasSubstr("line 5: Socket\\x: not connected"),
                    HasSubstr("the application has ended"), Not(HasSubstr("line 1:"))));
}

TEST(RunCommand, RefusesWhatAControllerWouldNotLoadAndAScriptThatIsNone) {
  val3::SmallProject broken;
  broken.number("n").program("start", "n=nothing");
  const SmallRun ran = run_small(broken.write().path(), "");
  EXPECT_EQ(ran.code, kCannotRun);
  EXPECT_THAT(ran.error, AllOf(HasSubstr("start.pgx:3"), HasSubstr("a controller would not load it")));
  val3::SmallProject right;
  right.program("start", "");
  const SmallRun script = run_small(right.write().path(), "0 jump\n");
  EXPECT_EQ(script.code, kCannotRun);
  EXPECT_THAT(script.error, HasSubstr("script.txt:1: 'jump' is no command"));
  EXPECT_EQ(run_small(right.path().parent_path() / "none.pjx", "").code, kCannotRun);
}

TEST(RunCommand, RefusesAScriptWithoutAnEndAndAFolder) {
  val3::SmallProject project;
  project.program("start", "").write();
  const SmallRun ran = run_small(project.path(), std::string(kScriptBytesMax + 1, '\n'));
  EXPECT_EQ(ran.code, kCannotRun);
  EXPECT_THAT(ran.error, HasSubstr("script.txt: a script of more than 1 MiB"));
  std::filesystem::path script = project.path().parent_path() / "script.txt";
  std::filesystem::remove(script);
  std::filesystem::create_directory(script);
  EXPECT_THAT(run_small(project.path(), "0 end\n").error, HasSubstr("script.txt: cannot be read"));
}

TEST(RunCommand, KeysEditAVariableUntilReturnAndEscLeavesIt) {
  val3::SmallProject project;
  project.number("n", 6).data("s", "string", "<Value key=\"0\" value=\"ab\"/>");
  project.program("start",
                  "userPage()\nn[0]=12\nn[1]=get(n[0])\nn[2]=get(n[0])\nn[3]=get(s)\nif s==\"aC\"\nn[4]=1\n"
                  "endIf\nwait(false)");
  const SmallRun ran =
      run_small(project.write().path(),
                "0.1 key 46\n0.2 key 53\n0.3 key 270\n0.4 expect-number n 12.5\n"
                "0.4 expect-number n[1] 270\n0.5 key 57\n0.6 key 255\n0.7 expect-number n 12.5\n"
                "0.7 expect-number n[2] 255\n0.8 key 263\n0.9 key 67\n1 key 273\n"
                "1.1 expect-number n[3] 273\n1.1 expect-number n[4] 1\n");
  EXPECT_EQ(ran.code, kRanWell) << ran.out;
}

TEST(RunCommand, ShowsWhatAnApplicationOfS8PutsOnItsPages) {
  val3::SmallProject project;
  project.number("n").program("start",
                              "n=0.5\nuserPageSet(\"uxMain\",\"lblTime\",\"innerHTML\",n)\n"
                              "userPageSet(\"uxMain\",\"box\",\"checked\",true)\nuserPageAlert(\"look\")");
  const SmallRun ran = run_small(project.write().path(), "");
  EXPECT_EQ(ran.code, kRanWell) << ran.out << ran.error;
  EXPECT_THAT(ran.out, AllOf(HasSubstr("uxMain.lblTime.innerHTML = 0.5\n"),
                             HasSubstr("uxMain.box.checked = true\n"), HasSubstr("log: look")));
}

TEST(RunCommand, RefusesAStartThatRunMemoryDoesNotHoldAndTellsAStackSizeOfNothing) {
  val3::SmallProject large;
  large.program("start", "l_n[0]=1", val3::SmallProject::local("l_n", "num", 100'000));
  const SmallRun refused = run_small(large.write().path(), "");
  EXPECT_EQ(refused.code, kCannotRun);
  EXPECT_THAT(refused.error,
              AllOf(HasSubstr("start() takes 800048 bytes of run memory (estimated), and stackSize is "
                              "5000; give the project a larger stackSize"),
                    HasSubstr("[run-memory]")));
  val3::SmallProject nothing;
  nothing.stack(0).program("start", "");
  const SmallRun ran = run_small(nothing.write().path(), "");
  EXPECT_EQ(ran.code, kRanWell);
  EXPECT_THAT(ran.out, HasSubstr("stackSize is 0: the usual 5000 bytes are taken"));
}

TEST(RunCommand, RefusesAScriptThatNamesASignalWhichIsNotThere) {
  val3::SmallProject project;
  project.data("di", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I7\"/>").program("start", "");
  const std::string at = project.write().path().string();
  const SmallRun mistyped = run_small(at, "0 power on\n0 input BasicI0-1\\%I7 on\n");
  EXPECT_EQ(mistyped.code, kCannotRun);
  EXPECT_EQ(mistyped.out, "");
  EXPECT_THAT(mistyped.error, AllOf(HasSubstr("script.txt:2: 'BasicI0-1\\%I7' is no digital input or output"),
                                    HasSubstr("there are: "), HasSubstr("BasicIO-1\\%I7")));
  EXPECT_EQ(run_small(at, "0 input BasicIO-1\\%I7 on\n").code, kRanWell);
}

TEST(RunCommand, TellsAtLoadWhatIsLinkedToACardThatIsNotThereAndItsUseFails) {
  val3::SmallProject project;
  project.flag("b").number("n").data("di", "dio", "<Value key=\"0\" link=\"NoCard\\nothing\"/>");
  project.program("start", "n=ioStatus(di)\ndelay(0.1)\nb=(di==true)");
  const std::string at = project.write().path().string();
  const SmallRun ran = run_small(at, "0.05 expect-number n -1\n");
  EXPECT_EQ(ran.code, kRanWithFailures);
  EXPECT_THAT(ran.error, HasSubstr("di is linked to NoCard\\nothing, and there is no card NoCard"));
  EXPECT_THAT(ran.out, AllOf(HasSubstr("ends with error 123 at start.pgx:5"), HasSubstr("1 failures")));
  const SmallRun declared = run_small(at, "0 card NoCard\n0.05 expect-number n 0\n");
  EXPECT_EQ(declared.code, kRanWell) << declared.out;
  EXPECT_EQ(declared.error, "");
}

TEST(RunCommand, RunsAnApplicationOfS6OnTheSignalsAndSocketsOfItsLibraryIo) {
  val3::ProjectFolder folder;
  val3::write_old_project(folder, "app",
                          "<numSection><num name=\"n\" public=\"false\"><valueNum index=\"0\" value=\"0\"/>"
                          "</num></numSection>\n"
                          "<dioSection><dio name=\"dOut\" public=\"false\" size=\"1\"/></dioSection>\n"
                          "<sioSection><sio name=\"si\" public=\"false\" size=\"1\"/></sioSection>\n",
                          {{"start",
                            "dioLink(dOut,io:bOut1)\nwait(io:bIn4==true)\nio:bOut0=true\ndOut=io:bOut0\n"
                            "sioLink(si,io:host)\nn=si\nsi=n+1\nio:bIn4=true"}});
  const SmallRun ran =
      run_small(folder.path() / "app" / "app.pjx",
                "0 expect-output bOut0 off\n0.1 input io:bIn4 on\n0.2 expect-output bOut0 on\n"
                "0.2 expect-output BasicIO-1\\%Q1 on\n0.3 connect host\n0.3 send host \"A\"\n"
                "0.4 expect-sent host \"B\"\n0.5 expect-task app~ 122\n");
  EXPECT_EQ(ran.code, kRanWithFailures) << ran.out << ran.error;
  EXPECT_EQ(ran.error, "");
  EXPECT_THAT(ran.out, AllOf(HasSubstr("ends with error 122 at start.pgx:12"), HasSubstr("1 failures")))
      << "an input is not written";
}

TEST(RunCommand, ASwitchOfS5RoundsAndTakesTheLastOfEqualCases) {
  const std::string code =
      "switch 2.4\ncase 2\nn=n+1\nbreak\ncase 2\nn=n+10\nbreak\ndefault\nn=n+100\nbreak\nendSwitch";
  const std::string data =
      "<numSection><num name=\"n\" public=\"false\"><valueNum index=\"0\" value=\"0\"/></num></numSection>\n";
  for (const auto& [version, taken] :
       std::vector<std::pair<std::string, std::string>>{{"s5.3", "10"}, {"s6.8", "100"}}) {
    val3::ProjectFolder folder;
    val3::write_old_project(folder, "app", data, {{"start", code}}, version);
    const SmallRun ran = run_small(folder.path() / "app" / "app.pjx", "0.1 expect-number n " + taken + "\n");
    EXPECT_EQ(ran.code, kRanWell) << version << ran.out << ran.error;
  }
}

TEST(RunCommand, SaysOfASignalThatOnlyTheCellCanHaveWhereItIsToBeGiven) {
  val3::ProjectFolder folder;
  val3::write_old_project(folder, "app",
                          "<dioSection><dio name=\"d\" public=\"false\" size=\"1\"/></dioSection>",
                          {{"start", "io:bVacuum=true\ndioLink(d,io:bLight)"}});
  const SmallRun ran = run_small(folder.path() / "app" / "app.pjx", "");
  EXPECT_EQ(ran.code, kCannotRun);
  EXPECT_THAT(ran.error,
              HasSubstr("start.pgx:5: 'io:bVacuum' is none of the signals that a controller has by "
                        "itself; put the cell's project io beside the application"));
  EXPECT_THAT(ran.error, HasSubstr("start.pgx:6: 'io:bLight' is none of the signals"));
}

TEST(RunCommand, RunsOurOwnApplication) {
  const SmallRun ran = run_small(TOUCHCAL_SOURCE_DIR "/cs8_protocol/val3/touchcal/touchcal.pjx", "", 2.0);
  EXPECT_EQ(ran.code, kRanWell) << ran.out << ran.error;
  EXPECT_THAT(ran.out, HasSubstr("task motion: status 1"));
}

}  // namespace
}  // namespace sim
