#include "sim_controller/run_links.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/val3/files/built_in_io.hpp"

namespace sim {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

val3::Global linked(const std::string& name, val3::Kind kind, const std::string& attribute,
                    const std::string& link) {
  val3::Global global;
  global.declared.name = name;
  global.declared.type = {kind};
  global.declared.file = "a.dtx";
  global.values.push_back(
      {.index = {0}, .key = {}, .attributes = {{attribute, link}}, .fields = {}, .line = 7});
  return global;
}

ScriptStep step(ScriptAct::Kind kind, const std::string& name) {
  return {.at_s = 0.0, .line = 3, .act = {.kind = kind, .name = name}};
}

TEST(RunLinks, AreThoseOfDataOfLibrariesOfGrippersOfFieldsAndOfTheCell) {
  val3::Application application;
  application.globals = {linked("d", val3::Kind::kDio, "link", "BasicIO-2\\%Q4"),
                         linked("a", val3::Kind::kAio, "link", "ModbusSrv-0\\Words\\level"),
                         linked("t", val3::Kind::kTool, "ioLink", "valve1"),
                         linked("si", val3::Kind::kSio, "link", "Socket\\host")};
  val3::Global record;
  record.declared.type = {val3::Kind::kUser, 0};
  const val3::Global field = linked("d", val3::Kind::kDio, "link", "UserIO\\usrIn1");
  record.values.push_back(
      {.index = {0}, .key = {}, .attributes = {}, .fields = {{field.declared, field.values}}});
  application.globals.push_back(record);
  val3::Library library;
  library.alias = "lib";
  library.application = std::make_shared<val3::Application>();
  library.application->globals = {linked("d", val3::Kind::kDio, "link", "bIn3")};
  application.libraries.push_back(library);

  const RunLinks links = links_of(application, {});
  EXPECT_THAT(links.digital,
              AllOf(Contains("BasicIO-2\\%Q4"), Contains("valve1"), Contains("UserIO\\usrIn1"),
                    Contains("BasicIO-1\\%I3"), Contains("FastIO\\fIn0"), Not(Contains("Socket\\host"))));
  EXPECT_THAT(links.analogue, ElementsAre("ModbusSrv-0\\Words\\level"));
  EXPECT_TRUE(links.not_there.empty());
}

TEST(RunLinks, HaveTheSignalsOfTheLibraryIo) {
  val3::Application application;
  EXPECT_THAT(links_of(application, {}).digital, Not(Contains("UserIO\\usrIn0")));
  val3::Library library;
  library.alias = "io";
  library.application = val3::built_in_io(application);
  application.libraries.push_back(library);
  const RunLinks links = links_of(application, {});
  EXPECT_THAT(links.digital,
              AllOf(Contains("UserIO\\usrIn0"), Contains("valve2"), Contains("BasicIO-1\\%I15")));
  EXPECT_THAT(links.analogue, ElementsAre("CBT_TEMP", "CPU_TEMP"));
}

TEST(RunLinks, SayWhatIsLinkedToACardThatIsNotThere) {
  val3::Application application;
  application.globals = {linked("d", val3::Kind::kDio, "link", "J206\\Gripper"),
                         linked("e", val3::Kind::kDio, "link", "BasicIO\\%I0")};
  const RunLinks links = links_of(application, {});
  EXPECT_THAT(links.not_there, ElementsAre(HasSubstr("a.dtx:7: d is linked to J206\\Gripper"),
                                           HasSubstr("there is no card BasicIO:")));
  EXPECT_THAT(links.digital, Not(Contains("J206\\Gripper")));
  const std::vector<ScriptStep> script{step(ScriptAct::Kind::kCard, "J206")};
  const RunLinks declared = links_of(application, cards_of(script));
  EXPECT_THAT(declared.not_there, ElementsAre(HasSubstr("BasicIO\\%I0")));
  EXPECT_THAT(declared.digital, Contains("J206\\Gripper"));
}

TEST(RunLinks, RefuseANameThatIsNotThereAndListThoseThatAre) {
  const RunLinks links{.digital = {"BasicIO-1\\%I0", "BasicIO-1\\%Q1"}, .analogue = {}, .not_there = {}};
  using Kind = ScriptAct::Kind;
  const auto refusal = [&](Kind kind, const std::string& name) {
    const std::vector<ScriptStep> script{step(Kind::kPage, "nix"), step(kind, name)};
    const auto refused = unknown_signal(script, links);
    EXPECT_EQ(refused ? refused->line : 3, 3);
    return refused ? refused->what : "none";
  };
  EXPECT_EQ(refusal(Kind::kInput, "bIn0"), "none") << "the name of s5";
  EXPECT_EQ(refusal(Kind::kInput, "io:bIn0"), "none");
  EXPECT_EQ(refusal(Kind::kExpectOutput, "BasicIO-1\\%Q1"), "none");
  EXPECT_THAT(refusal(Kind::kInput, "nix"),
              HasSubstr("'nix' is no digital input or output of the application; there are: BasicIO-1\\%I0, "
                        "BasicIO-1\\%Q1"));
  EXPECT_THAT(refusal(Kind::kExpectOutput, "BasicIO-1\\%q1"), HasSubstr("there are"));
  EXPECT_THAT(refusal(Kind::kAnalogue, "BasicIO-1\\%I0"), HasSubstr("it has none, leave the line out"));
}

TEST(RunLinks, ListSoManyNamesAndCountTheRest) {
  RunLinks links;
  for (int i = 100; i < 150; ++i) links.digital.insert("BasicIO-1\\%I" + std::to_string(i));
  const std::vector<ScriptStep> script{step(ScriptAct::Kind::kInput, "nix")};
  const auto refused = unknown_signal(script, links);
  ASSERT_TRUE(refused);
  EXPECT_THAT(refused->what, AllOf(HasSubstr("%I139 and 10 more"), Not(HasSubstr("%I140"))));
}

}  // namespace
}  // namespace sim
