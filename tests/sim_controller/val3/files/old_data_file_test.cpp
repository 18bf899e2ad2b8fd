// Applications of s5 and s6: their files give the same application as those of s7.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

constexpr const char* kXml = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\r\n";

std::string old_program(const std::string& name, const std::string& code, const std::string& declared = "") {
  return kXml + ("<programList xmlns=\"ProgramNameSpace\">\r\n<program name=\"" + name +
                 "\" public=\"false\">\r\n<description>caf\xE9</description>\r\n" + declared +
                 "<source>\r\n<code>\r\n\r\nbegin\r\n" + code +
                 "end\r\n\r\n</code>\r\n</source>\r\n</program>\r\n" + "</programList>\r\n");
}

ProjectFolder& write_old(ProjectFolder& folder, const std::string& sections) {
  folder.write(
      "old/old.pjx",
      kXml + std::string("<project xmlns=\"ProjectNameSpace\">\r\n"
                         "<parameters version=\"s6.8\" stackSize=\"15000\" millimeterUnit=\"false\"/>\r\n"
                         "<programSection><program file=\"START.PGX\"/><program file=\"stop.pgx\"/>"
                         "</programSection>\r\n<dataSection><data file=\"old.dtx\"/></dataSection>\r\n"
                         "<aliasSection><alias name=\"io\" interface=\"io\" autoload=\"true\" "
                         "password=\"\"/></aliasSection>\r\n</project>\r\n"));
  folder.write("old/old.dtx",
               kXml + ("<dataList xmlns=\"DataNameSpace\">\r\n" + sections + "</dataList>\r\n"));
  folder.write("old/start.pgx", old_program("start", ""));
  return folder.write("old/stop.pgx", old_program("stop", ""));
}

std::vector<std::string> told_of_sections(const std::string& sections) {
  ProjectFolder folder;
  return told(write_old(folder, sections).read("old").findings);
}

TEST(OldFiles, GiveTheAttributesOfNewOnes) {
  ProjectFolder folder;
  write_old(
      folder,
      "<dioSection><dio name=\"diIn\" public=\"true\" privilege=\"0\" size=\"4\"/></dioSection>\r\n"
      "<frameSection><frame name=\"world\" public=\"false\"><fFather alias=\"\" name=\"\" fatherIndex=\"0\"/>"
      "<valueFrame index=\"0\"><tfValue x=\"0\" y=\"0\" z=\"0\" rx=\"0\" ry=\"0\" "
      "rz=\"0\"/></valueFrame></frame>\r\n"
      "<frame name=\"fTable\" public=\"false\"><fFather alias=\"\" name=\"\" fatherIndex=\"0\"/>"
      "<valueFrame index=\"1\"><tfValue x=\"5\" y=\"0\" z=\"0\" rx=\"0\" ry=\"0\" rz=\"0\"/></valueFrame>"
      "<valueFrame index=\"0\"/></frame></frameSection>\r\n"
      "<jointVrbSection/>\r\n"
      "<pointSection><point name=\"p\" public=\"false\"><pFather alias=\"\" name=\"fTable\" "
      "fatherIndex=\"1\"/>"
      "<valuePoint index=\"0\"><tpValue x=\"1\" y=\"2\" z=\"3\" rx=\"4\" ry=\"5\" rz=\"6\"/>"
      "<cpValue shoulder=\"lefty\" elbow=\"esame\" wrist=\"wfree\"/></valuePoint></point></pointSection>\r\n"
      "<stringSection><string name=\"s\" public=\"false\"><valueString index=\"0\" "
      "value=\"caf\xE9\"/></string>"
      "</stringSection>\r\n"
      "<toolSection><tool name=\"t\" public=\"false\"><tFather alias=\"\" name=\"flange\" fatherIndex=\"0\"/>"
      "<valueTool index=\"0\"><ttValue x=\"0\" y=\"0\" z=\"7\" rx=\"0\" ry=\"0\" rz=\"0\"/>"
      "<io alias=\"io\" name=\"valve1\" ioIndex=\"0\" open=\"1\" "
      "close=\"2\"/></valueTool></tool></toolSection>\r\n");
  const ReadApplication read = folder.read("old");
  ASSERT_THAT(told(read.findings), IsEmpty());
  EXPECT_EQ(read.application.form, 5);
  EXPECT_EQ(read.application.stack_bytes, 15000U);
  EXPECT_FALSE(read.application.is_metric);
  const auto& globals = read.application.globals;
  ASSERT_EQ(globals.size(), 5U);  // world is always there
  EXPECT_THAT(globals[0].declared.sizes, ElementsAre(4));
  EXPECT_THAT(globals[1].declared.sizes, ElementsAre(2));
  EXPECT_THAT(globals[1].values.at(0).index, ElementsAre(1));
  EXPECT_EQ(globals[1].values[0].attributes.at("fatherId"), "world[0]");
  EXPECT_EQ(globals[2].values.at(0).attributes.at("fatherId"), "fTable[1]");
  EXPECT_EQ(globals[2].values[0].attributes.at("shoulder"), "lefty");
  EXPECT_EQ(globals[3].values.at(0).attributes.at("value"), "caf\xC3\xA9");
  EXPECT_THAT(globals[4].values.at(0).attributes,
              UnorderedElementsAre(Pair("x", "0"), Pair("y", "0"), Pair("z", "7"), Pair("rx", "0"),
                                   Pair("ry", "0"), Pair("rz", "0"), Pair("fatherId", "flange[0]"),
                                   Pair("ioLink", "valve1"), Pair("ioOpen", "1"), Pair("ioClose", "2")));
}

TEST(OldFiles, GivePrograms) {
  ProjectFolder folder;
  write_old(folder, "");
  folder.write("old/stop.pgx",
               old_program("stop", " if a&lt;1\r\n  b=\r\n endIf\r\n",
                           "<paramSection><param name=\"x\" type=\"num\" byVal=\"true\"/>"
                           "<param name=\"y\" type=\"joint\" byVal=\"false\"/></paramSection>\r\n"
                           "<localSection><local name=\"b\" type=\"num\" size=\"3\"/></localSection>\r\n"));
  const ReadApplication read = folder.read("old");
  EXPECT_THAT(told(read.findings), ElementsAre("stop.pgx:12 syntax", "stop.pgx:5 start-parameters"));
  const Program& program = read.application.programs.at(1);
  ASSERT_EQ(program.parameters.size(), 2U);
  EXPECT_EQ(program.parameters[0].dimensions, 0);
  EXPECT_TRUE(program.parameters[1].by_reference);
  EXPECT_EQ(program.parameters[1].dimensions, 1);
  EXPECT_THAT(program.locals.at(0).sizes, ElementsAre(3));
  EXPECT_EQ(program.lines.at(0).line, 11);
}

TEST(OldFiles, RefuseWhatAControllerRefuses) {
  EXPECT_THAT(
      told_of_sections("<numSection><num name=\"n\" public=\"false\"><valueNum index=\"0\" value=\"1\"/>"
                       "<valueNum index=\"0\" value=\"2\"/></num></numSection>"),
      ElementsAre("old.dtx:3 duplicate-index"));
  EXPECT_THAT(told_of_sections(
                  "<numSection><num name=\"n\" public=\"false\"><valueNum index=\"1\" value=\"1\"/></num>"
                  "</numSection>"),
              ElementsAre("old.dtx:3 bad-index"));
  EXPECT_THAT(told_of_sections("<fishSection/>"), ElementsAre("old.dtx:3 unknown-element"));
  EXPECT_THAT(
      told_of_sections("<numSection><num name=\"n\" public=\"false\"><valueNum index=\"0\" value=\"one\"/>"
                       "</num></numSection>"),
      ElementsAre("old.dtx:3 bad-value"));
}

TEST(OldFiles, RefuseATextThatNoStringHolds) {
  ProjectFolder folder;
  write_old(folder, "");
  folder.write("old/stop.pgx", old_program("stop", "s=\"" + std::string(200, 'a') + "\"\r\n"));
  const ReadApplication read = folder.read("old");
  ASSERT_THAT(told(read.findings), ElementsAre("stop.pgx:9 string-too-long"));
  EXPECT_EQ(read.findings[0].severity, Severity::kError);
}

}  // namespace
}  // namespace val3
