// touchcal setup and setup-arm: from answers, typed or in a file, to a cell that the daemon takes and that
// can be planned.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/folder.hpp"
#include "tests/end_to_end/process.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kPrograms = TOUCHCAL_PROGRAMS_DIR;

class SetupCommand : public ::testing::Test {
 protected:
  Finished run(std::vector<std::string> arguments) { return Process(arguments, folder_ / "call.err").wait(); }
  Finished setup(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"touchcal", "setup", file("cell")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// With these lines typed.
  int typed(const std::string& lines, const std::string& more) {
    write("typed", lines);
    const int status = std::system(("'" + kPrograms + "/touchcal' setup '" + file("cell") + "' " + more +
                                    " < '" + file("typed") + "' > '" + file("screen") + "' 2>&1")
                                       .c_str());
    return WEXITSTATUS(status);
  }
  std::string file(const std::string& name) { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(file(name)) << text;
    return file(name);
  }
  std::string read(const std::string& name) {
    std::ifstream stream(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::string answers(const std::string& more = "") {
    return write("answers.json", R"({"schema":"touchcal/setup/1","name":"press 3")" + more + "}");
  }

  Folder folder_;
};

TEST_F(SetupCommand, MakesACellThatPassesTheCheckAndPlansAllParameters) {
  const Finished made = setup({"--answers", answers(), "--scene", file("scene.svg"), "--json"});
  ASSERT_EQ(made.exit_code, cell::kExitDone) << made.err;
  EXPECT_LT(json::parse(made.out)["tip_box_max_by_recipe_mm"]["quick"], 1.0) << "as its plan promises";
  EXPECT_THAT(read("scene.svg"), HasSubstr("<svg"));
  const Finished check = run({"touchcald", "--cell", file("cell/cell.json"), "--state",
                              folder_.directory("state").string(), "--check"});
  EXPECT_EQ(check.exit_code, cell::kExitDone) << check.err;
  const Finished plan =
      run({"touchcal", "plan", "--cell", file("cell/cell.json"), "--recipe", "quick", "--json"});
  ASSERT_EQ(plan.exit_code, cell::kExitDone) << plan.err;
  EXPECT_EQ(json::parse(plan.out)["identifiable_count"], 25);
}

TEST_F(SetupCommand, MakesTheSameByTypingWithASceneAfterEachAnswer) {
  ASSERT_EQ(typed("press 3\n" + std::string(100, '\n'), "--no-plans --scene '" + file("scene.html") + "'"),
            cell::kExitDone)
      << read("screen");
  EXPECT_THAT(read("scene.html"), HasSubstr("press 3"));
  const std::string by_hand = read("cell/cell.json");
  std::filesystem::remove_all(folder_ / "cell");
  ASSERT_EQ(setup({"--answers", answers(), "--no-plans"}).exit_code, cell::kExitDone);
  EXPECT_EQ(read("cell/cell.json"), by_hand);
}

TEST_F(SetupCommand, WritesNothingWhenTheAnswersEndAndGoesOnWithThemNextTime) {
  EXPECT_EQ(typed("press 3\nthree-parallel\n", ""), cell::kExitUsage);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cell"));
  EXPECT_EQ(json::parse(read("cell.draft.json"))["name"], "press 3");
  EXPECT_EQ(typed(std::string(100, '\n'), "--no-plans"), cell::kExitDone) << read("screen");
  EXPECT_EQ(json::parse(read("cell/cell.json"))["name"], "press 3");
  EXPECT_EQ(json::parse(read("cell/arm.json"))["name"], "three-parallel");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cell.draft.json"));
}

TEST_F(SetupCommand, AsksAgainAfterANumberThatIsNoneAndLosesNoAnswer) {
  EXPECT_EQ(typed("press 3\n\nA-1\n\n1e999 0 0\n+1 2 3\nnan 1 2\n", ""), cell::kExitUsage);
  EXPECT_THAT(read("screen"), HasSubstr("1e999"));
  EXPECT_EQ(json::parse(read("cell.draft.json"))["arm_serial"], "A-1");
  // As in the dialogue, the answers that were kept make the cell.
  ASSERT_EQ(setup({"--no-plans", "--answers", file("cell.draft.json")}).exit_code, cell::kExitDone);
  EXPECT_EQ(json::parse(read("cell/cell.json"))["arm_serial"], "A-1");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cell.draft.json"));
}

TEST_F(SetupCommand, RefusesACellThatCannotBeRunWithWhatIsInTheWayAndTheDialogueGoesBackThere) {
  const std::string clash = R"(,"park_joints_deg":[0,60,90,0,30,0])";
  const Finished refused = setup({"--answers", answers(clash)});
  EXPECT_EQ(refused.exit_code, cell::kExitBadInput);
  EXPECT_THAT(refused.err, HasSubstr("in the park posture and must be 12 mm away"));
  const Finished far = setup(
      {"--no-plans", "--answers",
       answers(R"(,"base":{"position_mm":[-2500,-120,0],"rotation_deg":[90,0,0]},"keep_out_boxes":[])")});
  EXPECT_EQ(far.exit_code, cell::kExitBadInput);
  EXPECT_THAT(far.err, HasSubstr("plane 1: 0 of"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cell"));
  write("cell.draft.json", read("answers.json"));
  EXPECT_EQ(typed("yes\ndone\n", "--no-plans"), cell::kExitUsage);
  EXPECT_THAT(read("screen"),
              HasSubstr("Where the arm's base is in the block's frame: x y z, mm [-2500 -120 0]: "));
}

TEST_F(SetupCommand, ChangesACellOnlyWhenAskedAndNotWhatAPersonHasChanged) {
  ASSERT_EQ(setup({"--answers", answers(), "--no-plans"}).exit_code, cell::kExitDone);
  const Finished again = setup({"--answers", answers(), "--no-plans"});
  EXPECT_EQ(again.exit_code, cell::kExitUsage);
  EXPECT_THAT(again.err, HasSubstr("--change"));
  EXPECT_EQ(typed("press 4\n" + std::string(100, '\n'), "--no-plans --change"), cell::kExitDone)
      << read("screen");
  EXPECT_EQ(json::parse(read("cell/cell.json"))["name"], "press 4");
  json by_hand = json::parse(read("cell/cell.json"));
  by_hand["check_every_days"] = 7;
  write("cell/cell.json", by_hand.dump());
  EXPECT_EQ(typed(std::string(100, '\n'), "--no-plans --change"), cell::kExitUsage);
  EXPECT_THAT(read("screen"), HasSubstr("by an earlier version of it: cell.json"));
  EXPECT_EQ(json::parse(read("cell/cell.json")), by_hand);
  EXPECT_EQ(typed(std::string(100, '\n'), "--no-plans --change --force"), cell::kExitDone);
  EXPECT_FALSE(json::parse(read("cell/cell.json")).contains("check_every_days"));
}

TEST_F(SetupCommand, RefusesAnswersWithPlaceAndRemedy) {
  const Finished bad = setup({"--answers", answers(R"(,"nominal_miss_mm":500)")});
  EXPECT_EQ(bad.exit_code, cell::kExitBadInput);
  EXPECT_THAT(bad.err, HasSubstr("/nominal_miss_mm"));
  const Finished no_arm = setup({"--answers", answers(R"(,"arm":{"file":"tx91"})")});
  EXPECT_EQ(no_arm.exit_code, cell::kExitBadInput);
  EXPECT_THAT(no_arm.err, HasSubstr("shipped are three-parallel, tx60, tx90"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cell"));
}

TEST_F(SetupCommand, MakesACellOfATableOfDhParametersThatPassesTheCheck) {
  // The build of the UR5.
  write("ur5.csv",
        "theta_deg,d_mm,a_mm,alpha_deg\n0,89.159,0,90\n0,0,-425,0\n0,0,-392.25,0\n0,109.15,0,90\n0,94.65,0,-"
        "90\n0,82.3,0,"
        "0\n");
  const Finished arm = run({"touchcal", "setup-arm", "ur5", "--dh", file("ur5.csv"), "--dh-convention",
                            "standard", "--out", file("ur5.json")});
  EXPECT_EQ(arm.exit_code, cell::kExitDone) << arm.err;
  EXPECT_THAT(arm.err, HasSubstr("180 degrees a second are assumed"));
  EXPECT_EQ(json::parse(read("ur5.json"))["name"], "ur5");
  const Finished made =
      setup({"--no-plans", "--answers",
             answers(R"(,"arm":{"dh":")" + file("ur5.csv") + R"(","dh_convention":"standard"})")});
  ASSERT_EQ(made.exit_code, cell::kExitDone) << made.err;
  const Finished check = run({"touchcald", "--cell", file("cell/cell.json"), "--state",
                              folder_.directory("state").string(), "--check"});
  EXPECT_EQ(check.exit_code, cell::kExitDone) << check.err;
}

TEST_F(SetupCommand, ArmNeedsOneDescription) {
  EXPECT_EQ(run({"touchcal", "setup-arm", "x", "--out", file("x.json")}).exit_code, cell::kExitUsage);
  EXPECT_EQ(run({"touchcal", "setup-arm", "x", "--urdf", file("x.urdf"), "--out", file("x.json")}).exit_code,
            cell::kExitUsage);
  write("x.urdf", "<robot/>");
  const Finished no_link = run({"touchcal", "setup-arm", "x", "--urdf", file("x.urdf"), "--base", "a",
                                "--tip", "b", "--out", file("x.json")});
  EXPECT_EQ(no_link.exit_code, cell::kExitBadInput);
  EXPECT_THAT(no_link.err, HasSubstr("has no link \"a\""));
}

}  // namespace
}  // namespace touchcal::testing
