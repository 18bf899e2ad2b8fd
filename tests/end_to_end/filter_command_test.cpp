// touchcal compensate --dtx: a VAL3 data file filtered by the program itself, beside its correction of
// targets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kConfig = std::string(TOUCHCAL_SOURCE_DIR) + "/config/cells/edf/cell.json";
constexpr const char* kList = "jPick offline stylus\npA offline stylus\npSafe taught\n";

std::string data_with(const std::string& joints, const std::string& point) {
  return "\xEF\xBB\xBF<?xml version=\"1.0\" encoding=\"utf-8\"?>\r\n"
         "<Database xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
         "xmlns=\"http://www.staubli.com/robotics/VAL3/Data/2\">\r\n  <Datas>\r\n"
         "    <Data name=\"jPick\" access=\"private\" xsi:type=\"array\" type=\"jointRx\" size=\"1\">\r\n"
         "      <Value key=\"0\"" +
         joints +
         " />\r\n    </Data>\r\n"
         "    <Data name=\"pA\" access=\"private\" xsi:type=\"array\" type=\"pointRx\" size=\"1\">\r\n"
         "      <Value key=\"0\"" +
         point +
         " fatherId=\"world[0]\" />\r\n    </Data>\r\n"
         "    <Data name=\"pSafe\" access=\"private\" xsi:type=\"array\" type=\"pointRx\" size=\"1\">\r\n"
         "      <Value key=\"0\" x=\"700\" fatherId=\"world[0]\" />\r\n    </Data>\r\n"
         "  </Datas>\r\n</Database>\r\n";
}

/// The paper's arm as the shipped touches show it, a data file and a program.
class FilterCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const Finished identified =
        touchcal({"identify", "--cell", kConfig, "--touches",
                  std::string(TOUCHCAL_SOURCE_DIR) + "/tests/data/table3-exact.touches.json", "--export",
                  file("arm.json")});
    ASSERT_NE(bytes_in("arm.json"), "") << identified.err;
    write("cell.dtx", original_);
    write("points.list", kList);
    write("move.pgx",
          "<Programs xmlns=\"http://www.staubli.com/robotics/VAL3/Program/2\"><Program name=\"move\">"
          "<Code><![CDATA[begin\n  "
          "movej(appro(pA,{0,0,-50,0,0,0}),tProbe,mFast)\nend]]></Code></Program></Programs>");
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }
  std::string bytes_in(const std::string& name) {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  Finished touchcal(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "touchcal");
    return Process(arguments, folder_ / "call.err").wait();
  }
  Finished filter(const std::string& data, const std::string& out,
                  const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"compensate",        "--cell", kConfig,    "--arm",
                                       file("arm.json"),    "--dtx",  file(data), "--list",
                                       file("points.list"), "--out",  file(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return touchcal(arguments);
  }

  Folder folder_;
  std::string original_ =
      data_with(" j1=\"20\" j2=\"30\" j3=\"60\" j4=\"10\" j5=\"50\" j6=\"-20\"",
                " x=\"600\" y=\"60\" z=\"-200\" rx=\"170\" ry=\"5\" rz=\"7\" shoulder=\"lefty\" "
                "elbow=\"epositive\" wrist=\"wpositive\"");
};

TEST_F(FilterCommand, WritesWhatTheCorrectionOfTheSameTargetsSays) {
  const Finished finished = filter("cell.dtx", "out.dtx");
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("jPick "), HasSubstr("move.pgx:2: appro of pA: 185 um, at 50 mm"),
                                  HasSubstr("no project (.pjx) beside the data file")));
  EXPECT_EQ(bytes_in("cell.dtx"), original_);
  EXPECT_THAT(bytes_in("points.list"), StartsWith(std::string(kList) + "# filtered "));

  write("targets.csv", "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\npick,20,30,60,10,50,-20\n");
  const Finished corrected = touchcal({"compensate", "--cell", kConfig, "--arm", file("arm.json"),
                                       "--targets", file("targets.csv"), "--json"});
  ASSERT_EQ(corrected.exit_code, cell::kExitDone) << corrected.err;
  const auto joints = nlohmann::json::parse(corrected.out).at("targets").at(0).at("joints_deg");
  const std::string out = bytes_in("out.dtx");
  for (int i = 1; i <= 6; ++i) {
    const std::string name = " j" + std::to_string(i) + "=\"";
    EXPECT_NEAR(std::stod(out.substr(out.find(name) + name.size())),
                joints.at(static_cast<std::size_t>(i - 1)).get<double>(), 0.6e-6)
        << name;
  }
  EXPECT_THAT(out, StartsWith(original_.substr(0, original_.find(" j1="))));
  EXPECT_EQ(out.substr(out.find("pSafe")), original_.substr(original_.find("pSafe")));
}

TEST_F(FilterCommand, RefusesToFilterTwiceAndToReplaceWhatIsThere) {
  ASSERT_EQ(filter("cell.dtx", "out.dtx").exit_code, cell::kExitDone);
  const std::string first = bytes_in("out.dtx");
  const Finished twice = filter("out.dtx", "twice.dtx");
  EXPECT_EQ(twice.exit_code, cell::kExitBadInput);
  EXPECT_THAT(twice.err, HasSubstr("out.dtx: is filtered already"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "twice.dtx"));
  EXPECT_THAT(filter("cell.dtx", "out.dtx").err, HasSubstr("exists; choose another name or give --force"));
  EXPECT_THAT(filter("cell.dtx", "cell.dtx", {"--force"}).err,
              HasSubstr("is the original, which is never written"));
  EXPECT_EQ(filter("cell.dtx", "out.dtx", {"--force"}).exit_code, cell::kExitDone);
  EXPECT_EQ(bytes_in("out.dtx"), first);
  EXPECT_EQ(bytes_in("cell.dtx"), original_);
}

TEST_F(FilterCommand, KnowsItsPointsAgainWithAnotherListAndFromAnEditor) {
  ASSERT_EQ(filter("cell.dtx", "out.dtx").exit_code, cell::kExitDone);
  write("points.list", kList);
  const Finished fresh = filter("out.dtx", "twice.dtx");
  EXPECT_EQ(fresh.exit_code, cell::kExitBadInput) << fresh.out;
  EXPECT_THAT(fresh.err, HasSubstr("out.dtx: is filtered already, says "));
  write("saved.dtx", bytes_in("out.dtx") + "\n<!-- saved -->\n");
  const Finished saved = filter("saved.dtx", "twice.dtx");
  EXPECT_EQ(saved.exit_code, cell::kExitBadInput) << saved.out;
  EXPECT_THAT(saved.err, AllOf(HasSubstr("saved.dtx: jPick holds what a filter made, says "),
                               HasSubstr("out.dtx.filtered")));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "twice.dtx"));
}

TEST_F(FilterCommand, EndsWithOneWhenAValueIsRefusedAndLeavesItAlone) {
  write("cell.dtx", data_with(" j1=\"20\" j2=\"30\" j3=\"60\" j5=\"1\"", " x=\"9000\" z=\"1\""));
  const Finished finished = filter("cell.dtx", "out.dtx");
  EXPECT_EQ(finished.exit_code, cell::kExitLimitsMissed) << finished.err;
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("jPick[0] refused and left as it was: the wrist is within 1 deg of straight"),
                    HasSubstr("pA[0] refused and left as it was: out of reach")));
  EXPECT_EQ(bytes_in("out.dtx"), bytes_in("cell.dtx"));
  EXPECT_EQ(bytes_in("points.list"), kList) << "nothing was filtered";
}

TEST_F(FilterCommand, RefusesAListThatDoesNotFitAndWhatIsMissing) {
  write("points.list", "jPick offline saw\npA leave\npSafe taught\n");
  const Finished tool = filter("cell.dtx", "out.dtx");
  EXPECT_EQ(tool.exit_code, cell::kExitBadInput);
  EXPECT_THAT(tool.err,
              HasSubstr("points.list:1: \"jPick\" has the tool \"saw\", which is not there; write one of "));
  write("points.list", "pSafe taught\n");
  EXPECT_THAT(filter("cell.dtx", "out.dtx").err,
              HasSubstr("cell.dtx:4: \"jPick\" is a jointRx and is not in "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.dtx"));
  const auto usage = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"compensate", "--cell", kConfig, "--arm", file("arm.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished finished = touchcal(arguments);
    EXPECT_EQ(finished.exit_code, cell::kExitUsage);
    return finished.err;
  };
  EXPECT_THAT(usage({}), HasSubstr("give --targets, --dtx with --list, or --library"));
  EXPECT_THAT(usage({"--dtx", file("cell.dtx")}), HasSubstr("--dtx requires --list"));
  EXPECT_THAT(usage({"--dtx", file("cell.dtx"), "--list", file("points.list")}),
              HasSubstr("--out: name a file"));
}

}  // namespace
}  // namespace touchcal::testing
