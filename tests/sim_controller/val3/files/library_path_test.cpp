// Libraries: where they are looked for, and what is told of those that are not there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::string library(const std::string& path, const std::string& alias = "lib") {
  return "<Libraries><Library alias=\"" + alias + "\" path=\"" + path + "\"/></Libraries>\n";
}

/// An application in apps/cell/app, a library in apps/libs/tool and one in apps/cell/app/inner.
class Libraries : public testing::Test {
 protected:
  Libraries() {
    folder_.project("apps/libs/tool", "<Programs><Program file=\"hold.pgx\"/></Programs>")
        .program("apps/libs/tool/hold.pgx")
        .project("apps/cell/app/inner", "");
  }
  ReadApplication with(const std::string& path) {
    folder_.project("apps/cell/app", ProjectFolder::kStartAndStop + library(path))
        .program("apps/cell/app/start.pgx")
        .program("apps/cell/app/stop.pgx");
    return folder_.read("apps/cell/app");
  }
  std::string loaded_by(const std::string& path) {
    const ReadApplication read = with(path);
    const auto& found = read.application.libraries.at(0).application;
    return found ? found->name : read.findings.empty() ? "" : read.findings[0].rule;
  }
  ProjectFolder folder_;
};

TEST_F(Libraries, AreFoundByAllWritingsOfTheirPath) {
  EXPECT_EQ(loaded_by("Disk://libs/tool/tool.pjx"), "tool");
  EXPECT_EQ(loaded_by("Disk://libs/tool"), "tool");
  EXPECT_EQ(loaded_by("disk://LIBS/Tool/TOOL.PJX"), "tool");
  EXPECT_EQ(loaded_by("Disk://usr/old/tool/tool.pjx"), "library-missing");
  EXPECT_EQ(loaded_by("Disk://usr/libs/tool/tool.pjx"), "library-missing");
  EXPECT_EQ(loaded_by("/libs/tool"), "tool");
  EXPECT_EQ(loaded_by("./inner/inner.pjx"), "inner");
  EXPECT_EQ(loaded_by("inner"), "inner");
  EXPECT_EQ(loaded_by("../../libs/tool/tool.pjx"), "tool");
}

TEST_F(Libraries, ACopyOfACellMayLackTheOuterFolders) {
  folder_.project("apps/tool", "");
  EXPECT_EQ(loaded_by("Disk://gone/tool/tool.pjx"), "tool");
}

TEST_F(Libraries, AreReadWithTheirFaults) {
  folder_.program("apps/libs/tool/hold.pgx", " a=\n");
  const ReadApplication read = with("Disk://libs/tool");
  EXPECT_THAT(told(read.findings), ElementsAre("../../libs/tool/hold.pgx:5 syntax"));
  EXPECT_EQ(read.application.libraries[0].at.line, 5);
  EXPECT_GE(read.application.libraries[0].application->program_named("hold"), 0);
}

TEST_F(Libraries, ThatAreMissingAreAWarningAndTheBuiltInOneIsNone) {
  const ReadApplication read = with("Disk://gone/gone.pjx");
  ASSERT_THAT(told(read.findings), ElementsAre("app.pjx:5 library-missing"));
  EXPECT_EQ(read.findings[0].severity, Severity::kWarning);
  EXPECT_THAT(told(with("io").findings), IsEmpty());
  EXPECT_THAT(told(with("Disk://io").findings), IsEmpty());
}

TEST_F(Libraries, FarAwayOrEncryptedAreNotRead) {
  EXPECT_EQ(loaded_by("Disk://C:/windows"), "file-outside");
  EXPECT_EQ(loaded_by("../../../../../../../../etc"), "file-outside");
  folder_.write("apps/libs/secret.zip", "PK");
  EXPECT_EQ(loaded_by("Disk://libs/secret"), "library-encrypted");
}

TEST_F(Libraries, ThatUseEachOtherAreRefused) {
  EXPECT_EQ(loaded_by("Disk://app"), "circular-library");
  std::filesystem::remove(folder_.path() / "apps/libs/tool/hold.pgx");
  folder_.project("apps/libs/tool", library("Disk://cell/app"));
  const ReadApplication read = with("Disk://libs/tool");
  EXPECT_THAT(told(read.findings), ElementsAre("../../libs/tool/tool.pjx:4 circular-library"));
  EXPECT_EQ(read.application.libraries[0].application->libraries[0].application, nullptr);
}

TEST_F(Libraries, NestToADepthAndAreReadOnce) {
  for (int i = 0; i < 20; ++i)
    folder_.project("apps/l" + std::to_string(i), library("Disk://l" + std::to_string(i + 1)));
  folder_.project("apps/l20", "");
  EXPECT_THAT(told(with("Disk://l0").findings), ElementsAre("../../l7/l7.pjx:4 libraries-too-deep"));
  folder_.project("apps/cell/app",
                  ProjectFolder::kStartAndStop +
                      "<Libraries><Library alias=\"a\" path=\"Disk://libs/tool\" autoload=\"false\"/>"
                      "<Library alias=\"b\" path=\"Disk://libs/tool/tool.pjx\"/></Libraries>\n");
  const ReadApplication read = folder_.read("apps/cell/app");
  ASSERT_EQ(read.application.libraries.size(), 2U);
  EXPECT_EQ(read.application.libraries[0].application, read.application.libraries[1].application);
  EXPECT_FALSE(read.application.libraries[0].autoload);
  EXPECT_TRUE(read.application.libraries[1].autoload);
}

}  // namespace
}  // namespace val3
