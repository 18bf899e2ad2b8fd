#include "sim_controller/val3/check_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "sim_controller/val3/checks/sarif.hpp"
#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

struct Checked {
  CheckExit exit;
  std::string out, errors;
};

Checked checked(const std::filesystem::path& folder, bool json = false,
                std::optional<Version> language = std::nullopt) {
  std::ostringstream out, errors;
  const CheckExit exit = run_check({folder, language, json, "1.2.3"}, out, errors);
  return {exit, out.str(), errors.str()};
}

const std::string kNumber =
    "<Data name=\"n\" access=\"private\" xsi:type=\"array\" type=\"num\" size=\"1\"><Value key=\"0\" "
    "value=\"1\"/></Data>\n";

TEST(CheckCommand, AnApplicationAsItShouldBeIsClean) {
  ProjectFolder folder;
  folder.small(kNumber).program("app/start.pgx", "  n=n+1\n");
  const Checked result = checked(folder.path() / "app");
  EXPECT_EQ(result.exit, kCheckClean) << result.out;
  EXPECT_EQ(result.out, "0 errors, 0 warnings, 0 notes in 1 project\n");
  EXPECT_THAT(result.errors, IsEmpty());
}

TEST(CheckCommand, AFindingIsToldWithItsPlaceItsReasonAndItsRemedy) {
  ProjectFolder folder;
  folder.small(kNumber).program("app/start.pgx", "  n=\"text\"\n");
  const Checked result = checked(folder.path() / "app");
  EXPECT_EQ(result.exit, kCheckFindings);
  EXPECT_THAT(
      result.out,
      AllOf(
          HasSubstr((folder.path() / "app/start.pgx").string() +
                    ":5:5: error: what it is assigned to is a num, and this is a string [wrong-type]\n    "),
          HasSubstr("\n    Remedy: "), EndsWith("1 error, 0 warnings, 0 notes in 1 project\n")));
}

TEST(CheckCommand, ANoteAloneIsClean) {
  ProjectFolder folder;
  folder.small(kNumber);
  const Checked result = checked(folder.path() / "app");
  EXPECT_EQ(result.exit, kCheckClean);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("note: n is never used [unused-variable]"), HasSubstr("1 note in")));
}

TEST(CheckCommand, AFolderMayHoldSeveralProjectsAndALibraryNeedsNoStart) {
  ProjectFolder folder;
  folder.small(kNumber, "<Libraries><Library alias=\"lib\" path=\"Disk://lib/lib.pjx\"/></Libraries>\n")
      .program("app/start.pgx", "  n=lib:nShared\n  n=\"text\"\n");
  folder.project("lib", "<Programs/><Database><Data file=\"lib.dtx\"/></Database>\n")
      .data("lib/lib.dtx",
            "<Data name=\"nShared\" access=\"public\" xsi:type=\"array\" type=\"num\" size=\"1\"><Value "
            "key=\"0\" value=\"1\"/></Data>\n");
  Checked result = checked(folder.path());
  EXPECT_EQ(result.exit, kCheckFindings);
  EXPECT_THAT(result.out, EndsWith("1 error, 0 warnings, 0 notes in 2 projects\n"));
  // by itself it is no application, which is worth a note
  result = checked(folder.path() / "lib/lib.pjx");
  EXPECT_EQ(result.exit, kCheckClean);
  EXPECT_THAT(result.out, HasSubstr("[no-start]"));
}

TEST(CheckCommand, AVersionIsCheckedAgainst) {
  ProjectFolder folder;
  folder.small(kNumber).program("app/start.pgx", "  n=size(n,1)\n");
  EXPECT_EQ(checked(folder.path()).exit, kCheckClean);
  const Checked result = checked(folder.path(), false, language_named("s6"));
  EXPECT_EQ(result.exit, kCheckFindings);
  EXPECT_THAT(result.out, HasSubstr("[newer-instruction]"));
}

TEST(CheckCommand, VersionsAreNamedAsProjectsNameThem) {
  EXPECT_EQ(language_named("s7"), (Version{7, 99, 99}));
  EXPECT_EQ(language_named("s6.4"), (Version{6, 4, 99}));
  EXPECT_EQ(language_named("s7.7.2"), (Version{7, 7, 2}));
  for (const std::string_view wrong : {"", "s", "7", "s9", "s4", "s7.", "s7.x", "s7.7.2.1", "s-7", "s7 "})
    EXPECT_FALSE(language_named(wrong)) << wrong;
}

TEST(CheckCommand, WhatCannotBeReadIsTheThirdExitAndSaysWhatToDo) {
  ProjectFolder folder;
  EXPECT_EQ(checked(folder.path() / "none").exit, kCheckUnreadable);
  EXPECT_THAT(checked(folder.path() / "none").errors, HasSubstr("name a folder with a VAL3 project"));
  EXPECT_THAT(checked(folder.path()).errors, HasSubstr("holds no VAL3 project"));
  folder.write("app/notes.txt", "text");
  EXPECT_THAT(checked(folder.path() / "app/notes.txt").errors, HasSubstr("name a folder or a .pjx file"));
  folder.write("app/app.pjx", "<Project");
  const Checked broken = checked(folder.path());
  EXPECT_EQ(broken.exit, kCheckUnreadable);
  EXPECT_THAT(broken.out, HasSubstr("broken-xml"));
  EXPECT_THAT(broken.errors, HasSubstr("app.pjx cannot be read"));
}

TEST(CheckCommand, JsonIsSarif) {
  ProjectFolder folder;
  folder.small(kNumber).program("app/start.pgx", "  n=\"text\"\n  n=none\n");
  const Checked result = checked(folder.path() / "app", true);
  EXPECT_EQ(result.exit, kCheckFindings);
  const auto log = nlohmann::json::parse(result.out);
  EXPECT_EQ(log.at("version"), "2.1.0");
  const auto& run = log.at("runs").at(0);
  const auto& driver = run.at("tool").at("driver");
  EXPECT_EQ(driver.at("name"), "cs8sim");
  EXPECT_EQ(driver.at("version"), "1.2.3");
  ASSERT_EQ(run.at("results").size(), 2U);
  for (const auto& one : run.at("results")) {
    EXPECT_EQ(driver.at("rules").at(one.at("ruleIndex").get<std::size_t>()).at("id"), one.at("ruleId"));
    EXPECT_EQ(one.at("level"), "error");
    EXPECT_THAT(one.at("message").at("text").get<std::string>(), Not(IsEmpty()));
  }
  const auto& place = run.at("results").at(0).at("locations").at(0).at("physicalLocation");
  EXPECT_EQ(place.at("region").at("startLine"), 5);
  EXPECT_THAT(place.at("artifactLocation").at("uri").get<std::string>(),
              AllOf(testing::StartsWith("file:///"), EndsWith("/app/start.pgx")));
}

TEST(CheckCommand, SarifTakesAnyBytesOfAName) {
  std::ostringstream out;
  const Finding odd{Severity::kNote, "no-such-rule", {"a b\xff/100%.pgx", 0, 0}, "\xc3\x28 is odd", ""};
  write_sarif({odd}, "1", out);
  const auto log = nlohmann::json::parse(out.str());
  const auto& place = log.at("runs").at(0).at("results").at(0).at("locations").at(0).at("physicalLocation");
  EXPECT_EQ(place.at("artifactLocation").at("uri"), "a%20b%FF/100%25.pgx");
  EXPECT_FALSE(place.contains("region"));
}

TEST(CheckCommand, OurApplicationHasNothingAboveANote) {
  const Checked result = checked(std::filesystem::path(TOUCHCAL_SOURCE_DIR) / "cs8_protocol/val3/touchcal");
  EXPECT_EQ(result.exit, kCheckClean) << result.out;
}

}  // namespace
}  // namespace val3
