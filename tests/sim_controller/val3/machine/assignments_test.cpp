// Assignments to one place and to several: each place is written as its own type wants.
#include "sim_controller/val3/machine/assignments.hpp"

#include <gmock/gmock.h>

#include "sim_controller/val3/language/resolver.hpp"
#include "tests/sim_controller/val3/machine/evaluated.hpp"
#include "tests/sim_controller/val3/small_application.hpp"

namespace val3 {
namespace {

const std::string kLongText = "a text of more than sixteen bytes, which is kept elsewhere";

SmallProject& with_places(SmallProject& project, const std::string& lines) {
  project.data("di", "dio", "<Value key=\"0\" link=\"BasicIO-1\\%I0\"/>")
      .data("dq", "dio", "<Value key=\"1\" link=\"BasicIO-1\\%Q0\"/>", 2)
      .data("aq", "aio", "<Value key=\"0\" link=\"BasicIO-1\\%QW0\"/>")
      .data("si", "sio", "<Value key=\"0\" link=\"Socket\\host\"/>")
      .data("siOther", "sio", "<Value key=\"0\" link=\"Socket\\other\"/>");
  return with_variables(project).program("start", lines + "\nwait(false)");
}

std::string sent(const Socket& socket) { return {socket.to_host.begin(), socket.to_host.end()}; }

TEST(Assignments, ASignalAnywhereInAChainIsWrittenAndKeepsItsLink) {
  for (const std::string chain : {"b=dq[1]=true", "dq[1]=b=true", "b=dq[1]=dq[1]=true", "b=dq[1]=di"}) {
    SmallProject project;
    with_places(project, chain + "\nb[1]=dq[1]\nn=ioStatus(dq[1])");
    Running run(project);
    run.cabinet.inputs["BasicIO-1\\%I0"] = true;
    run.ticks(2);
    EXPECT_TRUE(run.cabinet.outputs["BasicIO-1\\%Q0"]) << chain << run.log();
    EXPECT_TRUE(run.truth("b") && run.machine().truth("b", 1)) << chain;
    EXPECT_EQ(run.number("n"), 0) << chain;
  }
}

TEST(Assignments, AnAnalogueOutputAnywhereInAChainIsWrittenAndKeepsItsLink) {
  for (const std::string chain : {"n=aq=3.5", "aq=n=3.5", "n=aq=n[1]=aq=3.5"}) {
    SmallProject project;
    with_places(project, chain + "\nn[2]=aq\nn[3]=ioStatus(aq)");
    Running run(project);
    run.ticks(2);
    EXPECT_EQ(run.cabinet.analogues["BasicIO-1\\%QW0"], 3.5) << chain << run.log();
    EXPECT_EQ(run.number("n"), 3.5) << chain;
    EXPECT_EQ(run.number("n", 2), 3.5) << chain;
    EXPECT_EQ(run.number("n", 3), 0) << chain;
  }
}

TEST(Assignments, AChannelAnywhereInAChainIsWritten) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"s=si=\"" + kLongText + "\"", kLongText + '\r'},
      {"si=s=\"" + kLongText + "\"", kLongText + '\r'},
      {"n=si=65", "A"},
      {"si=n=65", "A"},
      {"n=si=aq=65", "A"},
      {"si=siOther", "A"}};
  for (const auto& [chain, expected] : cases) {
    SmallProject project;
    with_places(project, chain + "\nn[1]=1");
    Running run(project);
    ASSERT_TRUE(run.cabinet.sockets["Socket\\host"].connect());
    ASSERT_TRUE(run.cabinet.sockets["Socket\\other"].connect());
    run.cabinet.sockets["Socket\\other"].to_controller = {65};
    run.ticks(2);
    EXPECT_EQ(sent(run.cabinet.sockets["Socket\\host"]), expected) << chain << run.log();
    EXPECT_EQ(run.number("n", 1), 1) << chain;
    if (chain.find("s=") != std::string::npos && chain.find('"') != std::string::npos) {
      EXPECT_EQ(run.text("s"), kLongText);
    }
  }
}

TEST(Assignments, NothingOfALineIsCarriedOutBeforeEachChannelTakesIt) {
  SmallProject project;
  with_places(project, "n[1]=sioCtrl(si,\"timeout\",0)\nsiOther=si=n=n+65");
  Running run(project);
  run.ticks(5);
  EXPECT_EQ(run.number("n"), 0) << "the line waits for its peers";
  ASSERT_TRUE(run.cabinet.sockets["Socket\\other"].connect());
  run.ticks(5);
  EXPECT_EQ(sent(run.cabinet.sockets["Socket\\other"]), "");
  ASSERT_TRUE(run.cabinet.sockets["Socket\\host"].connect());
  run.ticks(5);
  EXPECT_EQ(run.number("n"), 65);
  EXPECT_EQ(sent(run.cabinet.sockets["Socket\\host"]), "A");
  EXPECT_EQ(sent(run.cabinet.sockets["Socket\\other"]), "A");
}

TEST(Assignments, PlacesThatDoNotTakeOneValueAreRefused) {
  int refused_here = 0;
  for (const char* chain : {"n=s=si", "s=n=si", "aq=s=si", "j=t={1,2,3,4,5,6}", "t=j={1,2,3,4,5,6}"}) {
    SmallApplication small;
    small.global("num", "n").global("string", "s").global("sio", "si").global("aio", "aq");
    small.global("jointRx", "j").global("trsf", "t").program("start", chain).program("stop", "");
    Findings findings = std::move(small.findings);
    resolve(small.application, findings);
    std::erase_if(findings, [](const Finding& one) { return one.severity != Severity::kError; });
    if (!findings.empty()) continue;  // a controller refuses it too
    ++refused_here;
    Cabinet cabinet;
    const Machine machine(small.application, cabinet, findings);
    EXPECT_THAT(in_short(findings), testing::ElementsAre("start.pgx:2 not-simulated")) << chain;
  }
  EXPECT_GE(refused_here, 4);
}

}  // namespace
}  // namespace val3
