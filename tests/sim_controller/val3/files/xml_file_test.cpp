// Files that are broken, endless, in a circle or elsewhere: each is told with its place, and nothing fails.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "sim_controller/val3/files/application_reader.hpp"
#include "tests/sim_controller/val3/files/project_folder.hpp"

namespace val3 {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::string> told_of_program(const std::string& bytes) {
  ProjectFolder folder;
  folder.small("").write("app/stop.pgx", bytes);
  auto result = told(folder.read().findings);
  std::erase(result, "app.pjx:0 no-stop");
  return result;
}

std::string program_text(const std::string& before_root, const std::string& code) {
  return before_root +
         "<Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\"><Program "
         "name=\"stop\">\n<Code>" +
         code + "</Code></Program></Programs>\n";
}

TEST(HostileFiles, BrokenXmlIsToldByLine) {
  EXPECT_THAT(told_of_program(""), ElementsAre("stop.pgx:1 broken-xml"));
  EXPECT_THAT(told_of_program("<a>\n<b>\n</a>\n"), ElementsAre("stop.pgx:3 broken-xml"));
  EXPECT_THAT(told_of_program("<a/>\n<b/>\n"), ElementsAre("stop.pgx:2 broken-xml"));
  EXPECT_THAT(told_of_program(std::string("<a>\0</a>", 8)), ElementsAre("stop.pgx:0 broken-xml"));
  EXPECT_THAT(told_of_program("\n<Other/>\n"), ElementsAre("stop.pgx:2 unknown-form"));
  EXPECT_THAT(told_of_program("<?xml version=\"1.0\" encoding=\"utf-16\"?><a/>"),
              ElementsAre("stop.pgx:1 encoding"));
  EXPECT_THAT(told_of_program(program_text("", "")), ElementsAre("stop.pgx:1 no-code"));
}

TEST(HostileFiles, LinesAreCountedInEveryWriting) {
  const std::string fault = "begin\n a=\nend";
  EXPECT_THAT(told_of_program(program_text("\n", fault)), ElementsAre("stop.pgx:4 syntax"));
  EXPECT_THAT(told_of_program(program_text("\xEF\xBB\xBF<?xml version=\"1.0\"?>\r\n", fault)),
              ElementsAre("stop.pgx:4 syntax"));
  EXPECT_THAT(told_of_program(program_text("", "<![CDATA[\n\n" + fault + "]]>")),
              ElementsAre("stop.pgx:5 syntax"));
  EXPECT_THAT(told_of_program(program_text("", "<![CDATA[begin\r\n\r\n\r\n a=\r\nend]]>")),
              ElementsAre("stop.pgx:5 syntax"));
  EXPECT_THAT(told_of_program(program_text("", "<!-- one\ntwo -->\nbegin <!--\n--> \n a=\nend")),
              ElementsAre("stop.pgx:6 syntax"));
  EXPECT_THAT(told_of_program(program_text(
                  "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<!-- \xE9\xE9 -->\n", fault)),
              ElementsAre("stop.pgx:5 syntax"));
}

TEST(HostileFiles, AWrongEncodingIsToldAndRead) {
  EXPECT_THAT(told_of_program(program_text("", "begin\n// \xE9\nend")), ElementsAre("stop.pgx:0 encoding"));
}

TEST(HostileFiles, OneThatIsTooLargeIsNotRead) {
  ProjectFolder folder;
  folder.small("");
  std::filesystem::resize_file(folder.path() / "app/app.dtx", kFileBytesMax + 1);
  EXPECT_THAT(told(folder.read().findings), ElementsAre("app.dtx:0 file-too-large"));
}

TEST(HostileFiles, APipeIsNotWaitedFor) {
  ProjectFolder folder;
  folder.small("");
  std::filesystem::remove(folder.path() / "app/app.dtx");
  ASSERT_EQ(mkfifo((folder.path() / "app/app.dtx").c_str(), 0600), 0);
  EXPECT_THAT(told(folder.read().findings), ElementsAre("app.dtx:0 file-unreadable"));
}

TEST(HostileFiles, FieldsNestToADepth) {
  std::string data = "<Data name=\"x\" type=\"T\"><Value key=\"0\">";
  for (int i = 0; i < 1000; ++i) data += "<Field name=\"t\" type=\"T\"><Value key=\"0\">";
  for (int i = 0; i < 1000; ++i) data += "</Value></Field>";
  ProjectFolder folder;
  folder.small(data + "</Value></Data>\n", "<Types><Type name=\"T\" path=\"Disk://T\"/></Types>")
      .project(
          "T",
          "<Types><Type name=\"T\" path=\"Disk://T\"/></Types><Database><Data file=\"T.dtx\"/></Database>")
      .data("T/T.dtx", "<Data name=\"t\" access=\"public\" type=\"T\"/>\n");
  EXPECT_THAT(
      told(folder.read().findings),
      ElementsAre("../T/T.dtx:4 unknown-type", "../T/T.pjx:4 circular-type", "app.dtx:4 unknown-element"));
}

TEST(HostileFiles, TypesThatMultiplyAreCounted) {
  ProjectFolder folder;
  folder.small("<Data name=\"x\" type=\"T9\"/>\n", "<Types><Type name=\"T9\" path=\"Disk://T9\"/></Types>");
  for (int i = 0; i <= 9; ++i) {
    const std::string name = "T" + std::to_string(i);
    const std::string inner = i == 0 ? "num" : "T" + std::to_string(i - 1);
    folder
        .project(
            name,
            (i == 0 ? "" : "<Types><Type name=\"" + inner + "\" path=\"Disk://" + inner + "\"/></Types>") +
                "<Database><Data file=\"" + name + ".dtx\"/></Database>")
        .data(name + "/" + name + ".dtx",
              "<Data name=\"a\" access=\"public\" type=\"" + inner + "\" size=\"50\"/>\n");
  }
  const auto found = told(folder.read().findings);
  EXPECT_THAT(found, Not(IsEmpty()));
  EXPECT_THAT(found, Each(EndsWith("bad-size")));
}

TEST(HostileFiles, OneWithAThousandFaultsTellsOfAHundred) {
  std::string data;
  for (int i = 0; i < 1000; ++i) data += "<Data/>\n";
  ProjectFolder folder;
  folder.small(data);
  const auto found = told(folder.read().findings);
  EXPECT_EQ(found.size(), kFindingsPerFileMax + 1);
  EXPECT_EQ(
      std::ranges::count_if(found, [](const std::string& one) { return one.ends_with("too-many-findings"); }),
      1);
}

}  // namespace
}  // namespace val3
