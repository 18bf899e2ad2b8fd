// touchcal compensate: the document, the files, the table, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "config/arm_writer.hpp"
#include "service/base/exit_code.hpp"
#include "service/documents/tool_document.hpp"
#include "tests/end_to_end/compensated_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

class CompensateCommand : public CompensatedCell {};

TEST_F(CompensateCommand, CorrectsTargetsToWithinATenthOfAMicrometre) {
  const Finished finished = compensate("targets.json", {"--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  EXPECT_EQ(finished.err, "");
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("schema"), "touchcal/compensated/1");
  EXPECT_EQ(document.at("model").get<std::string>().size(), 64U);
  const json& pick = document.at("targets").at(0);
  EXPECT_EQ(pick.at("name"), "pick");
  EXPECT_EQ(pick.at("status"), "ok");
  EXPECT_EQ(pick.at("reason"), nullptr);
  EXPECT_EQ(pick.at("tip_uncertainty_mm"), nullptr);
  const json asked = {20, 30, 60, 10, 50, -20};
  const Eigen::Vector3d wanted_m = gripper_m(demo_.arm.model, asked);
  EXPECT_LT((gripper_m(truth_, pick.at("joints_deg")) - wanted_m).norm(), 1e-7);
  EXPECT_NEAR(pick.at("moved_mm").get<double>(), 1e3 * (gripper_m(truth_, asked) - wanted_m).norm(), 1e-6);
  EXPECT_LT(pick.at("residual_um").get<double>(), 0.1);
  EXPECT_EQ(document.at("targets").at(1).at("status"), "warned");
  EXPECT_THAT(document.at("targets").at(1).at("reason").get<std::string>(), HasSubstr("wrist"));
}

TEST_F(CompensateCommand, HasATouchedToolWhereItWasTouched) {
  cell::ToolDocument found{
      .arm = "tx90", .tool = "gripper", .of_run = "7", .touch_count = 8, .complete = true};
  found.verdict = {.accepted = true, .reasons = {}};
  found.drawn_mm = {0.0, 0.0, 250.0};
  found.position_mm = {0.3, -0.2, 250.5};
  found.world_box_rms_mm = 0.06;
  write("tool.json", document_text(found));
  const Finished finished = compensate("targets.json", {"--json", "--tool-file", file("tool.json")});
  ASSERT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("touched").at("from"), file("tool.json"));
  EXPECT_EQ(document.at("touched").at("position_mm"), json({0.3, -0.2, 250.5}));
  EXPECT_DOUBLE_EQ(document.at("targets").at(0).at("tip_uncertainty_mm").get<double>(), 0.06);
  const Eigen::Vector3d drawn_m = demo_.tools.at("gripper").translation();
  const Eigen::Vector3d touched_m(0.0003, -0.0002, 0.2505);
  const Eigen::Vector3d wanted_m = gripper_m(demo_.arm.model, {20, 30, 60, 10, 50, -20});
  const json& reached = document.at("targets").at(0).at("joints_deg");
  calib::KinematicModel applied = truth_;
  applied.links[kWristFrame].theta_rad = demo_.arm.model.links[kWristFrame].theta_rad;  // no touch sees it
  EXPECT_LT((gripper_m(applied, reached, touched_m) - wanted_m).norm(), 1e-7);
  EXPECT_GT((gripper_m(applied, reached, drawn_m) - wanted_m).norm(), 5e-4);

  EXPECT_THAT(compensate("targets.json", {"--tool-file", file("tool.json")}).out,
              HasSubstr("its tip as touched: " + file("tool.json")));
  expect_one_line(
      compensate("targets.json", {"--tool-file", file("tool.json"), "--tool-file", file("tool.json")}),
      cell::kExitUsage, {"tool.json is of the tool gripper too; give one of the two"});
  found.verdict.accepted = false;
  write("tool.json", document_text(found));
  expect_one_line(compensate("targets.json", {"--tool-file", file("tool.json")}), cell::kExitRefused,
                  {"did not find the tip of the tool gripper"});
  expect_one_line(compensate("targets.json", {"--tool-file", file("arm.json")}), cell::kExitRefused,
                  {"arm.json is no result of touchcal tool"});
  write("half.json", document_text(found).substr(0, 100));
  expect_one_line(compensate("targets.json", {"--tool-file", file("half.json")}), cell::kExitBadInput,
                  {"half.json", "write it again with touchcal show RUN --json"});
  found.verdict.accepted = true;
  found.arm = "tx60";
  write("tool.json", document_text(found));
  expect_one_line(compensate("targets.json", {"--tool-file", file("tool.json")}), cell::kExitBadInput,
                  {"tool.json: /arm: is \"tx60\" but the cell's arm is \"tx90\""});
  found.arm = "tx90";
  write("tool.json", document_text(found));
  write("t.csv", "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\na,20,30,60,10,50,-20\n");
  expect_one_line(compensate("t.csv", {"--tool-file", file("tool.json")}), cell::kExitUsage,
                  {"is of the tool gripper, and the targets are of stylus; leave it out"});
}

TEST_F(CompensateCommand, TakesAPoseInTheWorldWithNearJoints) {
  write("pose.json", R"({"schema":"touchcal/targets/1","tool":"gripper","targets":[
        {"name":"p","position_mm":[500,100,300],"rotation_deg":[0,150,0],"near_joints_deg":[10,30,80,0,60,0],
         "frame":"world"}]})");
  const json document = json::parse(compensate("pose.json", {"--json"}).out);
  const json& target = document.at("targets").at(0);
  ASSERT_EQ(target.at("status"), "ok") << target;
  EXPECT_LT((gripper_m(truth_, target.at("joints_deg")) - Eigen::Vector3d(0.5, 0.1, 0.3)).norm(), 1e-7);
  EXPECT_GT(target.at("moved_mm").get<double>(), 0.1);
}

TEST_F(CompensateCommand, EndsWithOneWhereATargetIsRefusedAndLeavesItAlone) {
  write("t.csv",
        "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\nwrist,20,30,60,10,0.5,-20\nfar,20,30,60,10,50,271\n"
        "good,20,30,60,10,50,-20\n");
  const Finished table = compensate("t.csv", {"--tool", "gripper", "--out", file("corrected.csv")});
  EXPECT_EQ(table.exit_code, cell::kExitLimitsMissed) << table.err;
  EXPECT_EQ(table.err, "");
  EXPECT_THAT(table.out, HasSubstr("wrist is within 0.5 deg of straight"));
  EXPECT_THAT(table.out, HasSubstr("joint 6 at 271.000000 deg, outside its range of -270 to 270 deg"));
  EXPECT_THAT(table.out, HasSubstr("1 targets of tool gripper corrected"));
  const std::string csv = bytes_in(file("corrected.csv"));
  EXPECT_THAT(csv, HasSubstr("\nwrist,,,,,,\nfar,,,,,,\ngood,"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
  const json document = json::parse(compensate("t.csv", {"--tool", "gripper", "--json"}).out);
  EXPECT_EQ(document.at("targets").at(0).at("joints_deg"), nullptr);
  EXPECT_EQ(document.at("targets").at(2).at("status"), "ok");
}

TEST_F(CompensateCommand, OverwritesAFileOnlyWithForce) {
  EXPECT_EQ(compensate("targets.json", {"--out", file("out.json")}).exit_code, cell::kExitDone);
  const std::string first = bytes_in(file("out.json"));
  EXPECT_EQ(json::parse(first).at("schema"), "touchcal/compensated/1");
  write("out.json", "mine");
  const Finished again = compensate("targets.json", {"--out", file("out.json")});
  expect_one_line(again, cell::kExitUsage, {"out.json exists", "--force"});
  EXPECT_EQ(bytes_in(file("out.json")), "mine");
  EXPECT_EQ(compensate("targets.json", {"--out", file("out.json"), "--force"}).exit_code, cell::kExitDone);
  EXPECT_EQ(bytes_in(file("out.json")), first);
  expect_one_line(compensate("targets.json", {"--out", "-"}), cell::kExitUsage, {"--out", "name a file"});
}

TEST_F(CompensateCommand, NeverWritesOverTheTargets) {
  const std::string before = bytes_in(file("targets.json"));
  const Finished finished = compensate("targets.json", {"--out", file("targets.json"), "--force"});
  expect_one_line(finished, cell::kExitUsage, {"--out", "is the file of the targets"});
  EXPECT_EQ(bytes_in(file("targets.json")), before);
}

TEST_F(CompensateCommand, TheModelIsTheArmThatWasUsed) {
  const auto model_of = [this](const std::string& arm) {
    return json::parse(compensate("targets.json", {"--json"}, arm).out).at("model");
  };
  write("laid_out.json", json::parse(bytes_in(file("arm.json"))).dump(4));
  arm_.model.links[3].d_m += 1e-6;
  write("other.json", cell::arm_document(arm_));
  EXPECT_EQ(model_of("arm.json"), model_of("laid_out.json"));
  EXPECT_NE(model_of("arm.json"), model_of("other.json"));
}

TEST_F(CompensateCommand, RefusesWhatIsOfAnotherCellOrNoTarget) {
  write("tool.json", R"({"schema":"touchcal/targets/1","tool":"welder","targets":[
        {"name":"a","joints_deg":[20,30,60,10,50,-20]}]})");
  expect_one_line(compensate("tool.json"), cell::kExitBadInput,
                  {"tool.json: /tool: is \"welder\"", "give one of stylus, gripper"});
  write("frame.json", R"({"schema":"touchcal/targets/1","tool":"gripper","targets":[
        {"name":"a","frame":"pallet","position_mm":[1,2,3],"rotation_deg":[0,0,0],"near_joints_deg":[0,0,0,0,0,0]}]})");
  expect_one_line(compensate("frame.json"), cell::kExitBadInput,
                  {"frame.json: /targets/0/frame: is \"pallet\"", "give one of world, or add it"});
  expect_one_line(compensate("targets.json", {"--tool", "gripper"}), cell::kExitUsage,
                  {"--tool", "names its tool itself"});
  write("t.csv", "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\na,20,30,60,10,50,-20\n");
  expect_one_line(compensate("t.csv", {"--tool", "welder"}), cell::kExitBadInput, {"--tool", "welder"});
  arm_.name = "tx60";
  write("tx60.json", cell::arm_document(arm_));
  expect_one_line(compensate("targets.json", {}, "tx60.json"), cell::kExitBadInput,
                  {"tx60.json: /name: is \"tx60\" but the cell's arm is \"tx90\""});
  expect_one_line(compensate("missing.json"), cell::kExitBadInput, {"missing.json"});
  expect_one_line(compensate("targets.json", {}, "missing.json"), cell::kExitBadInput, {"missing.json"});
}

TEST_F(CompensateCommand, WarnsOfAnArmThatNobodyCalibrated) {
  write("nominal.json", cell::arm_document(demo_.arm));  // of the type: it has no serial number
  const Finished finished = compensate("targets.json", {"--json"}, "nominal.json");
  EXPECT_EQ(finished.exit_code, cell::kExitDone);
  EXPECT_THAT(finished.err, HasSubstr("is as the cell's own arm"));
  EXPECT_LT(json::parse(finished.out).at("targets").at(0).at("moved_mm").get<double>(), 1e-9);
}

/// Two lines, of which the second one has no length.
constexpr const char* kLines = R"("targets":[
  {"name":"start","joints_deg":[20,30,60,10,50,-20]},
  {"name":"end","joints_deg":[-10,30,60,10,50,-20],"move":"line"},
  {"name":"again","joints_deg":[-10,30,60,10,50,-20],"move":"line"}]})";

TEST_F(CompensateCommand, PutsPointsOnAStraightLineThatBowsTooFar) {
  write("lines.json", R"({"schema":"touchcal/targets/2","tool":"gripper",)" + std::string(kLines));
  const Finished finished = compensate("lines.json", {"--json", "--out", file("lines.csv")});
  EXPECT_EQ(finished.exit_code, cell::kExitDone) << finished.err;
  const json document = json::parse(finished.out);
  EXPECT_EQ(document.at("schema"), "touchcal/compensated/2");
  const json& targets = document.at("targets");
  ASSERT_GT(targets.size(), 5U);
  const std::size_t end = targets.size() - 2;
  const Eigen::Vector3d from_m = gripper_m(demo_.arm.model, {20, 30, 60, 10, 50, -20});
  const Eigen::Vector3d to_m = gripper_m(demo_.arm.model, {-10, 30, 60, 10, 50, -20});
  std::string csv_names;
  for (std::size_t i = 1; i < end; ++i) {
    EXPECT_EQ(targets.at(i).at("name"), "end." + std::to_string(i));
    EXPECT_EQ(targets.at(i).at("inserted"), true);
    EXPECT_TRUE(targets.at(i).at("line_deviation_mm").is_null());
    const Eigen::Vector3d wanted_m =
        from_m + (to_m - from_m) * (static_cast<double>(i) / static_cast<double>(end));
    EXPECT_LT((gripper_m(truth_, targets.at(i).at("joints_deg")) - wanted_m).norm(), 1e-7);
  }
  EXPECT_LE((to_m - from_m).norm() / static_cast<double>(end), 0.0501);
  EXPECT_EQ(targets.at(end).at("name"), "end");
  EXPECT_EQ(targets.at(end).at("inserted"), false);
  EXPECT_LE(targets.at(end).at("line_deviation_mm").get<double>(), 0.02);
  EXPECT_EQ(targets.back().at("name"), "again");
  EXPECT_LT(targets.back().at("line_deviation_mm").get<double>(), 1e-4);
  const std::string csv = bytes_in(file("lines.csv"));
  EXPECT_EQ(std::ranges::count(csv, '\n'), static_cast<std::ptrdiff_t>(targets.size() + 1));
  EXPECT_THAT(csv, HasSubstr("\nend.1,"));
  const Finished table = compensate("lines.json");
  EXPECT_THAT(table.out, HasSubstr("on a straight line, at most 0.0"));
  EXPECT_THAT(table.out, HasSubstr("of them are points inserted on straight lines"));
}

TEST_F(CompensateCommand, TheLimitOfALineIsTheOptionsElseTheFiles) {
  write("wide.json",
        R"({"schema":"touchcal/targets/2","tool":"gripper","line_max_mm":10,)" + std::string(kLines));
  const auto count = [this](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json::parse(compensate("wide.json", arguments).out).at("targets").size();
  };
  EXPECT_EQ(count({}), 3U);
  const std::size_t usual = count({"--line-max", "0.02"});
  EXPECT_GT(usual, 5U);
  EXPECT_GT(count({"--line-max", "0.001"}), usual);
  for (const char* wrong : {"-1", "0", "nan", "inf", "1e9", "0.0001", ""}) {
    const Finished refused = compensate("wide.json", {"--line-max", wrong});
    EXPECT_EQ(refused.exit_code, cell::kExitUsage) << wrong;
    EXPECT_THAT(refused.err, HasSubstr("--line-max"));
  }
  expect_one_line(compensate("targets.json", {"--line-max", "0.1"}), cell::kExitUsage,
                  {"--line-max", "targets.json has no straight lines", "touchcal/targets/2"});
}

TEST_F(CompensateCommand, RefusesTheEndOfALineThroughAStraightWristAndLinesThatAreNone) {
  write("through.json", R"({"schema":"touchcal/targets/2","tool":"gripper","targets":[
        {"name":"a","joints_deg":[20,30,60,0,20,0]},
        {"name":"b","joints_deg":[20,30,60,180,20,-180],"move":"line"}]})");
  const Finished through = compensate("through.json", {"--json"});
  EXPECT_EQ(through.exit_code, cell::kExitLimitsMissed) << through.err;
  const json end = json::parse(through.out).at("targets").back();
  EXPECT_EQ(end.at("name"), "b");
  EXPECT_EQ(end.at("status"), "refused");
  EXPECT_TRUE(end.at("joints_deg").is_null());
  EXPECT_TRUE(end.at("line_deviation_mm").is_null());
  EXPECT_THAT(end.at("reason").get<std::string>(), HasSubstr("the straight line from a cannot be held"));
  EXPECT_THAT(end.at("reason").get<std::string>(), HasSubstr("by a joint move, or split the line"));
  write("first.json", R"({"schema":"touchcal/targets/2","tool":"gripper","targets":[
        {"name":"a","joints_deg":[20,30,60,10,50,-20],"move":"line"}]})");
  expect_one_line(compensate("first.json"), cell::kExitBadInput,
                  {"first.json: /targets/0/move", "no target is before the first one"});
  write("old.json", R"({"schema":"touchcal/targets/1","tool":"gripper",)" + std::string(kLines));
  expect_one_line(compensate("old.json"), cell::kExitBadInput,
                  {"old.json: /targets/1/move: unknown key \"move\"", "raise \"schema\" to 2"});
  write("names.json", R"({"schema":"touchcal/targets/2","tool":"gripper","targets":[
        {"name":"b.1","joints_deg":[20,30,60,10,50,-20]},
        {"name":"b","joints_deg":[-10,30,60,10,50,-20],"move":"line"}]})");
  expect_one_line(compensate("names.json"), cell::kExitBadInput,
                  {"names.json: /targets/1/name", "a target has that name"});
}

/// The stylus of a CSV: frame 7 is the calibrated one.
TEST_F(CompensateCommand, ACsvIsOfTheStylusWithoutAnotherWord) {
  write("t.csv", "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\na,20,30,60,10,50,-20\n");
  const auto moved = [this](const std::vector<std::string>& more) {
    return json::parse(compensate("t.csv", more).out).at("targets").at(0).at("moved_mm");
  };
  EXPECT_EQ(moved({"--json"}), moved({"--json", "--tool", "stylus"}));
  EXPECT_NE(moved({"--json"}), moved({"--json", "--tool", "gripper"}));
}

}  // namespace
}  // namespace touchcal::testing
