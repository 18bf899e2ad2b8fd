// Applications of s7 and s8: what their files say, and what a controller refuses in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim_controller/val3/files/project_file.hpp"
#include "sim_controller/val3/language/resolver.hpp"
#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

const StoredValue& value_of(const ReadApplication& read, const std::string& name, std::size_t value = 0) {
  const int index = read.application.global_named(name);
  EXPECT_GE(index, 0) << name;
  return read.application.globals.at(static_cast<std::size_t>(index)).values.at(value);
}

/// What is told of one variable's element, which is line 4 of app.dtx.
std::vector<std::string> told_of_data(const std::string& data, const std::string& version = "s7.7.2") {
  ProjectFolder folder;
  folder.small(data, "", version);
  return told(folder.read().findings);
}

std::vector<std::string> told_of_value(const std::string& type, const std::string& attributes) {
  return told_of_data("<Data name=\"x\" type=\"" + type + "\" size=\"2\"><Value key=\"1\" " + attributes +
                      "/></Data>\n");
}

TEST(Files, OfOurOwnApplicationHaveNoFault) {
  const ReadApplication read = read_application(TOUCHCAL_SOURCE_DIR "/cs8_protocol/val3/touchcal");
  EXPECT_THAT(told(read.findings), IsEmpty());
  EXPECT_EQ(read.application.name, "touchcal");
  EXPECT_EQ(read.application.language, (Version{7, 7, 2}));
  EXPECT_GE(read.application.program_named("taskReceive"), 0);
  EXPECT_EQ(value_of(read, "diContact").attributes.at("link"), "FastIO\\fIn0");
}

TEST(Files, SayWhatAProgramIs) {
  ProjectFolder folder;
  folder.small("", "<Types><Type name=\"Pair\" path=\"../types/Pair\"/></Types>\n")
      .program("app/start.pgx", "  n=\n",
               "<Parameters xmlns=\"http://www.staubli.com/robotics/VAL3/Param/1\">\n"
               "<Parameter name=\"a\" type=\"num\" xsi:type=\"element\" use=\"value\" dimensions=\"1\"/>\n"
               "<Parameter name=\"b\" type=\"Pair\" xsi:type=\"array\" use=\"reference\" dimensions=\"2\"/>\n"
               "</Parameters>\n<Locals>\n"
               "<Local name=\"c\" type=\"jointRx\" xsi:type=\"array\" size=\"1 30\"/>\n</Locals>\n")
      .project("types/Pair", "<Database><Data file=\"Pair.dtx\"/></Database>")
      .data("types/Pair/Pair.dtx",
            "<Data name=\"x\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"3\"/>\n"
            "<Data name=\"own\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"1\"/>\n");
  const ReadApplication read = folder.read();
  EXPECT_THAT(told(read.findings), ElementsAre("start.pgx:12 syntax", "start.pgx:5 start-parameters"));
  const Program& program = read.application.programs.at(0);
  EXPECT_EQ(program.line, 3);
  ASSERT_EQ(program.parameters.size(), 2U);
  EXPECT_EQ(program.parameters[0].dimensions, 0);
  EXPECT_FALSE(program.parameters[0].by_reference);
  EXPECT_EQ(program.parameters[1].dimensions, 2);
  EXPECT_TRUE(program.parameters[1].by_reference);
  EXPECT_EQ(program.parameters[1].type, (Type{Kind::kUser, 0}));
  ASSERT_EQ(program.locals.size(), 1U);
  EXPECT_EQ(program.locals[0].type.kind, Kind::kJoint);
  EXPECT_THAT(program.locals[0].sizes, ElementsAre(1, 30));
  ASSERT_EQ(read.application.user_types.at(0).fields.size(), 1U);
  EXPECT_EQ(read.application.user_types[0].fields[0].declared.name, "x");
}

TEST(Files, SayWhatDataAre) {
  ProjectFolder folder;
  folder.small(
      "<Data name=\"fCell\" access=\"public\" xsi:type=\"array\" type=\"frame\" size=\"2\">\n"
      "  <Value key=\"1\" x=\"1.5\" rz=\"-90\" fatherId=\"fCell[0]\"/><Value key=\"0\" "
      "fatherId=\"world[0]\"/></Data>\n"
      "<Data name=\"mOff\" xsi:type=\"array\" type=\"mdesc\" size=\"1\"><Value key=\"0\" "
      "blend=\"off\"/></Data>\n"
      "<Data name=\"nGrid\" xsi:type=\"array\" type=\"num\" size=\"2 3\"><Value key=\"1 2\" value=\"7\"/>"
      "<Value key=\"2\" value=\"8\"/></Data>\n"
      "<Data name=\"sBy\" xsi:type=\"collection\" type=\"string\"><Value key=\"a b\" value=\"\"/></Data>\n"
      "<Data name=\"scPage\" xsi:type=\"array\" type=\"screen\" size=\"1\"/>\n");
  const ReadApplication read = folder.read();
  ASSERT_THAT(told(read.findings), IsEmpty());
  EXPECT_THAT(value_of(read, "fCell").attributes,
              UnorderedElementsAre(Pair("x", "1.5"), Pair("rz", "-90"), Pair("fatherId", "fCell[0]")));
  EXPECT_THAT(value_of(read, "fCell").index, ElementsAre(1));
  EXPECT_TRUE(read.application.globals[0].is_public);
  EXPECT_FALSE(read.application.globals[1].is_public);
  EXPECT_THAT(value_of(read, "nGrid").index, ElementsAre(1, 2));
  EXPECT_THAT(value_of(read, "nGrid", 1).index, ElementsAre(0, 2));
  EXPECT_TRUE(read.application.globals[3].declared.is_collection());
  EXPECT_EQ(value_of(read, "sBy").key, "a b");
  EXPECT_EQ(read.application.globals[4].declared.type.kind, Kind::kScreen);
}

TEST(Files, FieldsOfUserTypesNest) {
  ProjectFolder folder;
  folder
      .small(
          "<Data name=\"q\" type=\"Outer\" size=\"2\"><Value key=\"1\"><Field name=\"inner\" "
          "xsi:type=\"array\" "
          "type=\"Inner\" size=\"2\"><Value key=\"0\"><Field name=\"n\" xsi:type=\"array\" type=\"num\" "
          "size=\"1\">"
          "<Value key=\"0\" value=\"4\"/></Field></Value></Field></Value></Data>\n"
          "<Data name=\"r\" type=\"Outer\"><Value key=\"0\"><Field name=\"none\" "
          "type=\"num\"/></Value></Data>\n",
          "<Types><Type name=\"Outer\" path=\"Disk://types/Outer/Outer.pjx\"/></Types>")
      .project("types/Outer",
               "<Types><Type name=\"Inner\" path=\"Disk://types/Inner/Inner.pjx\"/></Types>"
               "<Database><Data file=\"Outer.dtx\"/></Database>")
      .data("types/Outer/Outer.dtx", "<Data name=\"inner\" access=\"public\" type=\"Inner\" size=\"2\"/>\n")
      .project("types/Inner", "<Database><Data file=\"Inner.dtx\"/></Database>")
      .data("types/Inner/Inner.dtx", "<Data name=\"n\" access=\"public\" type=\"num\" size=\"1\"/>\n");
  const ReadApplication read = folder.read();
  EXPECT_THAT(told(read.findings), ElementsAre("app.dtx:5 unknown-element"));
  ASSERT_EQ(read.application.user_types.size(), 2U);  // the inner one, which is not listed, comes behind
  EXPECT_EQ(read.application.user_types[0].fields.at(0).declared.type, (Type{Kind::kUser, 1}));
  const StoredField& inner = value_of(read, "q").fields.at(0);
  EXPECT_EQ(inner.values.at(0).fields.at(0).values.at(0).attributes.at("value"), "4");
}

TEST(Files, ATypeThatHoldsItselfIsRefused) {
  ProjectFolder folder;
  folder.small("", "<Types><Type name=\"A\" path=\"Disk://A\"/></Types>")
      .project("A", "<Types><Type name=\"B\" path=\"Disk://B\"/></Types>")
      .project("B", "<Types><Type name=\"A\" path=\"Disk://A\"/></Types>");
  EXPECT_THAT(told(folder.read().findings), ElementsAre("../B/B.pjx:4 circular-type"));
}

TEST(Files, ValuesOfTheWrongFormAreRefused) {
  EXPECT_THAT(told_of_value("num", "value=\"1e-3\""), IsEmpty());
  EXPECT_THAT(told_of_value("num", "value=\"1,5\""), ElementsAre("app.dtx:4 bad-value"));
  EXPECT_THAT(told_of_value("num", "value=\"nan\""), ElementsAre("app.dtx:4 bad-value"));
  EXPECT_THAT(told_of_value("num", "x=\"1\""), ElementsAre("app.dtx:4 unknown-attribute"));
  EXPECT_THAT(told_of_value("bool", "value=\"yes\""), ElementsAre("app.dtx:4 bad-value"));
  EXPECT_THAT(told_of_value("jointRs", "j5=\"1\""), ElementsAre("app.dtx:4 unknown-attribute"));
  EXPECT_THAT(told_of_value("mdesc", "blend=\"round\""), ElementsAre("app.dtx:4 bad-value"));
  EXPECT_THAT(told_of_value("pointRx", "shoulder=\"left\""), ElementsAre("app.dtx:4 bad-value"));
  EXPECT_THAT(told_of_value("string", "value=\"" + std::string(129, 'a') + "\""),
              ElementsAre("app.dtx:4 string-too-long"));
}

TEST(Files, IndicesAndSizesAreChecked) {
  const auto with_keys = [](const std::string& first, const std::string& second) {
    return told_of_data("<Data name=\"x\" type=\"num\" size=\"2\"><Value key=\"" + first +
                        "\"/><Value key=\"" + second + "\"/></Data>\n");
  };
  EXPECT_THAT(with_keys("1", "0"), IsEmpty());
  EXPECT_THAT(with_keys("1", "1"), ElementsAre("app.dtx:4 duplicate-index"));
  EXPECT_THAT(with_keys("0", "2"), ElementsAre("app.dtx:4 bad-index"));
  EXPECT_THAT(with_keys("0", "-1"), ElementsAre("app.dtx:4 bad-index"));
  const auto of_size = [](const std::string& size) {
    return told_of_data("<Data name=\"x\" type=\"num\" size=\"" + size + "\"/>\n");
  };
  EXPECT_THAT(of_size("1000 6"), IsEmpty());
  EXPECT_THAT(of_size("many"), ElementsAre("app.dtx:4 bad-size"));
  EXPECT_THAT(of_size("1 2 3 4"), ElementsAre("app.dtx:4 bad-size"));
  EXPECT_THAT(of_size("99999999 99999999 99999999"), ElementsAre("app.dtx:4 bad-size"));
  EXPECT_THAT(told_of_data("<Data name=\"a\" type=\"num\" size=\"1500000\"/>\n"
                           "<Data name=\"b\" type=\"num\" size=\"1500000\"/>\n"),
              ElementsAre("app.dtx:5 bad-size"));
}

TEST(Files, FathersMustBeThere) {
  const auto in = [](const std::string& father) {
    return told_of_data("<Data name=\"p\" type=\"pointRx\"><Value key=\"0\" fatherId=\"" + father +
                        "\"/></Data>\n<Data name=\"f\" type=\"frame\" size=\"2\"/>\n"
                        "<Data name=\"n\" type=\"num\"/>\n");
  };
  EXPECT_THAT(in("world[0]"), IsEmpty());
  EXPECT_THAT(in("f[1]"), IsEmpty());
  EXPECT_THAT(in(""), IsEmpty());
  EXPECT_THAT(in("f[2]"), ElementsAre("app.dtx:4 missing-father"));
  EXPECT_THAT(in("none[0]"), ElementsAre("app.dtx:4 missing-father"));
  EXPECT_THAT(in("n[0]"), ElementsAre("app.dtx:4 missing-father"));
  EXPECT_THAT(in("flange[0]"), ElementsAre("app.dtx:4 missing-father"));
  EXPECT_THAT(in("lib:f[0]"), ElementsAre("app.dtx:4 missing-father"));
  EXPECT_THAT(in("f[x]"), ElementsAre("app.dtx:4 bad-value"));
  EXPECT_THAT(told_of_data("<Data name=\"a\" type=\"frame\"><Value key=\"0\" fatherId=\"b[0]\"/></Data>\n"
                           "<Data name=\"b\" type=\"frame\"><Value key=\"0\" fatherId=\"a[0]\"/></Data>\n"
                           "<Data name=\"c\" type=\"frame\"><Value key=\"0\" fatherId=\"a[0]\"/></Data>\n"),
              ElementsAre("app.dtx:4 circular-father"));
}

TEST(Files, NamesAreCheckedByVersion) {
  const auto named = [](const std::string& name, const std::string& version) {
    return told_of_data("<Data name=\"" + name + "\" type=\"num\"/>\n", version);
  };
  EXPECT_THAT(named("nOfFifteenChars", "s6.8"), IsEmpty());
  EXPECT_THAT(named("nOfSixteenChars_", "s6.8"), ElementsAre("app.dtx:4 name-too-long"));
  EXPECT_THAT(named("nOfSixteenChars_", "s7.7"), ElementsAre("app.dtx:4 name-too-long"));
  EXPECT_THAT(named("nOfSixteenChars_", "s8.10.3Cs9_BS2093"), IsEmpty());
  EXPECT_THAT(named("endFor", "s7.7"), ElementsAre("app.dtx:4 reserved-name"));
  EXPECT_THAT(named("a-b", "s7.7"), ElementsAre("app.dtx:4 invalid-name"));
  EXPECT_THAT(named("1a", "s7.7"), ElementsAre("app.dtx:4 invalid-name"));
  EXPECT_THAT(told_of_data("<Data name=\"a\" type=\"num\"/>\n<Data name=\"a\" type=\"bool\"/>\n"),
              ElementsAre("app.dtx:5 duplicate-name"));
  EXPECT_THAT(told_of_data("<Data name=\"a\" type=\"num\"/>\n<Data name=\"A\" type=\"bool\"/>\n"), IsEmpty());
}

TEST(Files, ProgramsThatAControllerRefusesAreRefused) {
  const auto declaring = [](const std::string& declared) {
    ProjectFolder folder;
    folder.small("").program("app/stop.pgx", "", declared);
    return told(folder.read().findings);
  };
  EXPECT_THAT(declaring("<Parameters><Parameter name=\"a\" type=\"num\" xsi:type=\"array\"/></Parameters>\n"),
              ElementsAre("stop.pgx:4 array-by-value", "stop.pgx:4 start-parameters"));
  EXPECT_THAT(declaring("<Locals><Local name=\"a\" type=\"nothing\" size=\"1\"/></Locals>\n"),
              ElementsAre("stop.pgx:4 unknown-type"));
  EXPECT_THAT(
      declaring("<Locals><Local name=\"a\" type=\"num\"/><Local name=\"a\" type=\"num\"/></Locals>\n"),
      ElementsAre("stop.pgx:4 duplicate-name"));
  EXPECT_THAT(declaring("<Locals><Local name=\"a\" type=\"num\" size=\"999999\"/></Locals>\n"),
              ElementsAre("stop.pgx:4 bad-size"));
  EXPECT_THAT(declaring("<Remark/>\n"), ElementsAre("stop.pgx:4 unknown-element"));
}

TEST(Files, AVariableOfAnUnknownTypeIsToldOnce) {
  ProjectFolder folder;
  folder.small("<Data name=\"a\" type=\"unheard\"/>\n<Data name=\"b\" type=\"num\"/>\n");
  folder.program("app/start.pgx", "b=a.nField+a[1]\na=b\n");
  ReadApplication read = folder.read();
  resolve(read.application, read.findings);
  EXPECT_THAT(told(read.findings), ElementsAre("app.dtx:4 unknown-type"));
}

TEST(Files, WhatALaterVersionMayHaveAddedIsAWarning) {
  ProjectFolder folder;
  folder.small("<Data name=\"a\" type=\"num\" newer=\"1\"><Newer/></Data>\n");
  const ReadApplication read = folder.read();
  ASSERT_THAT(told(read.findings), ElementsAre("app.dtx:4 unknown-attribute", "app.dtx:4 unknown-element"));
  for (const Finding& finding : read.findings) EXPECT_EQ(finding.severity, Severity::kWarning);
}

TEST(Files, AnApplicationHasStartAndStop) {
  ProjectFolder folder;
  folder.project("app", "<Programs><Program file=\"start.pgx\"/></Programs>").program("app/start.pgx");
  EXPECT_THAT(told(folder.read().findings), ElementsAre("app.pjx:0 no-stop"));
  folder.project("app", "<Programs><Program file=\"stop.pgx\"/></Programs>").program("app/stop.pgx");
  EXPECT_THAT(told(folder.read().findings), ElementsAre("app.pjx:0 no-start", "app.pjx:0 unlisted-program"));
  folder.project("lib", "");
  const ReadApplication library = folder.read("lib");
  ASSERT_THAT(told(library.findings), ElementsAre("lib.pjx:0 no-start"));
  EXPECT_EQ(library.findings[0].severity, Severity::kWarning);
}

TEST(Files, AreFoundWithoutRegardToCaseAndInSubFoldersOnly) {
  ProjectFolder folder;
  folder
      .project("app",
               "<Programs><Program file=\"Start.pgx\"/><Program file=\"sub/stop.pgx\"/>"
               "<Program file=\"gone.pgx\"/><Program file=\"../other/start.pgx\"/>"
               "<Program file=\"/etc/passwd\"/><Program file=\"START.pgx\"/></Programs>\n")
      .program("app/start.pgx")
      .program("app/sub/stop.pgx")
      .program("other/start.pgx");
  const ReadApplication read = folder.read();
  EXPECT_THAT(told(read.findings), ElementsAre("app.pjx:4 duplicate-name", "app.pjx:4 file-missing",
                                               "app.pjx:4 file-outside", "app.pjx:4 file-outside"));
  EXPECT_EQ(read.application.programs.size(), 2U);
  EXPECT_EQ(read.application.programs[1].file, "sub/stop.pgx");
}

TEST(Files, AProjectIsNamedOrItsFolderIs) {
  ProjectFolder folder;
  folder.small("");
  EXPECT_EQ(read_application(folder.path() / "app" / "app.pjx").application.programs.size(), 2U);
  EXPECT_THAT(told(read_application(folder.path() / "gone").findings), ElementsAre("gone:0 no-project"));
  folder.write("none/readme.txt", "").write("two/a.pjx", "").write("two/b.pjx", "");
  EXPECT_THAT(told(folder.read("none").findings), ElementsAre("none:0 no-project"));
  EXPECT_THAT(told(folder.read("two").findings), ElementsAre("two:0 no-project"));
}

TEST(Files, VersionsAreReadInAllWritings) {
  EXPECT_EQ(version_in("s7.7.2"), (Version{7, 7, 2}));
  EXPECT_EQ(version_in("s6.8"), (Version{6, 8, 0}));
  EXPECT_EQ(version_in("~VAL3:s5.4~Options:s5.2.4"), (Version{5, 4, 0}));
  EXPECT_EQ(version_in("s8.13.1Cs9_BS2800"), (Version{8, 13, 1}));
  EXPECT_EQ(version_in("Cs9"), std::nullopt);
  EXPECT_EQ(version_in(""), std::nullopt);
}

TEST(ReadApplication, AStackSizeThatNoControllerHasIsRefused) {
  for (const auto& [bytes, is_taken] :
       {std::pair(kStackBytesMax, true), std::pair(kStackBytesMax + 1, false)}) {
    ProjectFolder folder;
    folder.small("");
    std::ifstream file(folder.path() / "app/app.pjx");
    std::string project{std::istreambuf_iterator<char>(file), {}};
    project.replace(project.find("5000"), 4, std::to_string(bytes));
    folder.write("app/app.pjx", project);
    const ReadApplication read = folder.read();
    if (is_taken) {
      EXPECT_THAT(told(read.findings), IsEmpty());
      EXPECT_EQ(read.application.stack_bytes, bytes);
      continue;
    }
    ASSERT_THAT(told(read.findings), ElementsAre("app.pjx:3 bad-value"));
    EXPECT_EQ(read.findings[0].remedy, "write a number of bytes up to 16777216; 5000 is usual");
  }
}

}  // namespace
}  // namespace val3
