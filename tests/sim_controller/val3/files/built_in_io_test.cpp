#include "sim_controller/val3/files/built_in_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/val3/language/resolver.hpp"
#include "tests/sim_controller/val3/files/old_project.hpp"
#include "tests/sim_controller/val3/small_application.hpp"

namespace val3 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::string kNumberSection =
    "<numSection><num name=\"n\" public=\"false\"><valueNum index=\"0\" value=\"0\"/></num></numSection>\n"
    "<sioSection><sio name=\"si\" public=\"false\" size=\"1\"/></sioSection>\n";

std::string link_of(const Application& io, const std::string& name, std::size_t element = 0) {
  const int index = io.global_named(name);
  if (index < 0) return "none";
  return io.globals[static_cast<std::size_t>(index)].values.at(element).attributes.at("link");
}

TEST(BuiltInIo, HasTheSignalsOfAControllerAndTheSocketsThatAProgramNames) {
  SmallApplication small;
  small.program("start", "sioLink(si,io:host)\nn=sioGet(io:port2,n)\nn=io:mine\nb=io:bIn3");
  const auto io = built_in_io(small.application);
  EXPECT_TRUE(io->is_built_in);
  for (const char* name :
       {"bIn0", "bIn15", "bOut15", "fIn1", "fOut0", "usrIn1", "valve1", "valve2", "SECTEUR_OK"})
    EXPECT_EQ(link_of(*io, name), name);
  for (const char* name : {"bIn16", "fIn2", "usrIn2", "valve0", "valve3", "mine"})
    EXPECT_EQ(link_of(*io, name), "none");
  EXPECT_EQ(io->globals[static_cast<std::size_t>(io->global_named("CPU_TEMP"))].declared.type.kind,
            Kind::kAio);
  for (const char* name : {"host", "port2"}) {
    ASSERT_EQ(link_of(*io, name), name);
    EXPECT_EQ(io->globals[static_cast<std::size_t>(io->global_named(name))].declared.type.kind, Kind::kSio);
  }
}

TEST(BuiltInIo, HasTheSignalsOfBoardsThatAProgramNames) {
  SmallApplication small;
  small.program("start",
                "io:bOut16=true\nif io:bIn999==true\nn=1\nendIf\nio:bIn1000=io:bIn020\nio:fIn7=false");
  const auto io = built_in_io(small.application);
  for (const char* name : {"bOut16", "bIn999"}) EXPECT_EQ(link_of(*io, name), name);
  for (const char* name : {"bIn16", "bIn1000", "bIn020", "fIn7"}) EXPECT_EQ(link_of(*io, name), "none");
}

TEST(BuiltInIo, HasTheSocketsThatAreSetToAStringOrThatAStringIsSetTo) {
  SmallApplication small;
  small.global("string", "s", {4}).global("num", "n");
  small.program(
      "start",
      "s[1]=io:first\nio:second=\"abc\"\nio:third=toString(\"\",n)+l_s\nl_s=io:fourth\nn=io:number\n"
      "io:bOut3=true\nio:flag=true\nif s[0]==\"a\"\nio:fifth=\"a\"+s[2]\nendIf",
      {}, {{"string", "l_s"}});
  const auto io = built_in_io(small.application);
  for (const char* name : {"first", "second", "third", "fourth", "fifth"}) {
    ASSERT_EQ(link_of(*io, name), name);
    EXPECT_EQ(io->globals[static_cast<std::size_t>(io->global_named(name))].declared.type.kind, Kind::kSio);
  }
  for (const char* name : {"number", "flag"}) EXPECT_EQ(link_of(*io, name), "none");
}

TEST(BuiltInIo, IsThereInAnApplicationOfS6AndTellsANameThatItHasNot) {
  ProjectFolder folder;
  write_old_project(
      folder, "app", kNumberSection,
      {{"start", "io:bOut0=true\nsioLink(si,io:host)\nn=io:CPU_TEMP\nio:nix=true\nio:bin3=false"}});
  ReadApplication read = folder.read();
  ASSERT_THAT(told(read.findings), IsEmpty());
  resolve(read.application, read.findings);
  EXPECT_THAT(told(read.findings), ElementsAre("start.pgx:8 unknown-signal", "start.pgx:9 unknown-signal"));
  EXPECT_EQ(read.findings[0].severity, Severity::kNote) << "a board of the cell may have it";
  EXPECT_EQ(read.findings[1].severity, Severity::kWarning);
  EXPECT_EQ(read.findings[1].remedy, "write io:bIn3: upper and lower case differ");
}

TEST(BuiltInIo, GivesWayToAProjectOfTheCellWhoseEntriesAreItsSignals) {
  ProjectFolder folder;
  write_old_project(folder, "io",
                    "<dioSection><dio name=\"bVacuum\" public=\"true\" size=\"2\"/></dioSection>\n"
                    "<sioSection><sio name=\"sHost\" public=\"true\" size=\"1\"/></sioSection>\n",
                    {});
  write_old_project(folder, "app", kNumberSection, {{"start", "io:bVacuum[1]=true\nio:bOut0=true"}});
  ReadApplication read = folder.read();
  resolve(read.application, read.findings);
  EXPECT_THAT(told(read.findings), ElementsAre("start.pgx:6 undefined-name"));
  const Application& io = *read.application.libraries.at(0).application;
  EXPECT_FALSE(io.is_built_in);
  EXPECT_EQ(link_of(io, "bVacuum"), "bVacuum");
  EXPECT_EQ(link_of(io, "bVacuum", 1), "bVacuum[1]");
  EXPECT_EQ(link_of(io, "sHost"), "sHost");
}

TEST(BuiltInIo, IsNotThereInAnApplicationOfS7) {
  ProjectFolder folder;
  folder.small("<Data name=\"n\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"1\"/>\n")
      .program("app/start.pgx", "io:bOut0=true\n");
  ReadApplication read = folder.read();
  EXPECT_THAT(read.application.libraries, IsEmpty());
  resolve(read.application, read.findings);
  EXPECT_THAT(told(read.findings), ElementsAre("start.pgx:5 undefined-library"));
}

}  // namespace
}  // namespace val3
