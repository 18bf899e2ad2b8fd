// touchcal compensate: poses in frames of the cell, RoboDK's lists, and whose arm it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "service/base/exit_code.hpp"
#include "tests/end_to_end/compensated_cell.hpp"

namespace touchcal::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class CompensateFrames : public CompensatedCell {};

/// The shipped cell's file with these keys, beside it.
std::string changed_cell(const Folder& folder, const json& keys) {
  for (const std::string part : {"arms", "cells", "recipes"})
    std::filesystem::copy(std::string(TOUCHCAL_SOURCE_DIR) + "/config/" + part,
                          folder.directory("config") / part, std::filesystem::copy_options::recursive);
  const auto file = folder / "config/cells/demo/cell.json";
  json cell = json::parse(std::ifstream(file));
  cell.update(keys);
  std::ofstream(file) << cell;
  return file.string();
}

TEST_F(CompensateFrames, TakesPosesInAFrameOfTheCell) {
  const json frame = {{"position_mm", {300, -200, -100}}, {"rotation_deg", {0, 0, 30}}, {"touched", "no"}};
  json nominal = frame;
  nominal["touched"] = "nominal";
  const std::string cell = changed_cell(
      folder_, {{"schema", "touchcal/cell/7"}, {"target_frames", {{"pallet", frame}, {"fixture", nominal}}}});
  const auto in_frame = [&](const std::string& name, const json& position_mm, double rz_deg) {
    write("pose.json", json{{"schema", "touchcal/targets/1"},
                            {"tool", "gripper"},
                            {"targets",
                             {{{"name", "a"},
                               {"frame", name},
                               {"position_mm", position_mm},
                               {"rotation_deg", {180, 0, rz_deg}},
                               {"near_joints_deg", {10, 30, 60, 10, 50, -20}}}}}}
                           .dump());
    return Process({"touchcal", "compensate", "--cell", cell, "--arm", file("arm.json"), "--targets",
                    file("pose.json"), "--json"},
                   folder_ / "call.err")
        .wait();
  };
  // 100, 200, 0 of the pallet are 300 + 100 cos 30 - 200 sin 30, -200 + 100 sin 30 + 200 cos 30, -100.
  const Finished pallet = in_frame("pallet", {100, 200, 0}, 0);
  ASSERT_EQ(pallet.exit_code, cell::kExitDone) << pallet.err << pallet.out;
  const double half_root_3 = std::sqrt(0.75);
  // Rot(z, 30) Rot(x, 180) = Rot(x, 180) Rot(z, -30)
  const Finished world =
      in_frame("world", {300 + 100 * half_root_3 - 100, -200 + 50 + 200 * half_root_3, -100}, -30);
  const json one = json::parse(pallet.out).at("targets").at(0),
             same = json::parse(world.out).at("targets").at(0);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(one.at("joints_deg").at(i).get<double>(), same.at("joints_deg").at(i).get<double>(), 1e-9);
  expect_one_line(in_frame("fixture", {0, 0, 0}, 0), cell::kExitBadInput,
                  {"pose.json: /targets/0/frame: is \"fixture\"", "touched with the nominal arm"});
  expect_one_line(in_frame("palet", {0, 0, 0}, 0), cell::kExitBadInput,
                  {"give one of world, fixture, pallet"});
}

TEST_F(CompensateFrames, ListsThePosesToBeCommandedForRobodkAndReadsSuchAList) {
  write("t.csv",
        "name,j1_deg,j2_deg,j3_deg,j4_deg,j5_deg,j6_deg\npick,20,30,60,10,50,-20\nfar,20,30,60,10,0,-20\n");
  const Finished finished =
      compensate("t.csv", {"--tool", "gripper", "--out", file("list.csv"), "--format", "robodk", "--json"});
  EXPECT_EQ(finished.exit_code, cell::kExitLimitsMissed) << finished.err;
  const json joints_deg = json::parse(finished.out).at("targets").at(0).at("joints_deg");
  const std::string text = bytes_in(file("list.csv"));
  EXPECT_THAT(text, HasSubstr("# refused and left out: far: the wrist is within"));
  EXPECT_THAT(text, HasSubstr("# touchcal: corrected for the calibrated arm "));
  expect_one_line(compensate("list.csv", {"--tool", "gripper"}), cell::kExitBadInput,
                  {"hold the correction already"});
  const std::string line = text.substr(text.find("\npick, ") + 7);
  std::array<double, 12> numbers{};
  for (std::size_t at = 0, begin = 0; at < numbers.size(); ++at) {
    numbers.at(at) = std::stod(line.substr(begin));
    begin = line.find(", ", begin) + 2;
  }
  const Eigen::Vector3d commanded_mm = 1e3 * gripper_m(demo_.arm.model, joints_deg);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(numbers.at(i), commanded_mm[static_cast<Eigen::Index>(i)], 1e-6);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(numbers.at(i + 6), joints_deg.at(i).get<double>(), 1e-6);

  // What was meant, as such a list, is what the joints meant.
  write("meant.csv", "Name,X,Y,Z,Rx,Ry,Rz,J1,J2,J3,J4,J5,J6\npick, " + line);
  const Finished again = compensate("meant.csv", {"--tool", "gripper", "--json"});
  ASSERT_EQ(again.exit_code, cell::kExitDone) << again.err;
  EXPECT_LT(json::parse(again.out).at("targets").at(0).at("residual_um").get<double>(), 0.1);
  EXPECT_EQ(compensate("meant.csv", {"--frame", "world"}).exit_code, cell::kExitDone);
  expect_one_line(compensate("meant.csv", {"--frame", "pallet"}), cell::kExitBadInput,
                  {"--frame: is \"pallet\"", "give one of world"});
  expect_one_line(compensate("t.csv", {"--frame", "world"}), cell::kExitUsage, {"has joints and no poses"});
  expect_one_line(compensate("targets.json", {"--frame", "world"}), cell::kExitUsage,
                  {"names the frame of each pose"});
  expect_one_line(compensate("targets.json", {"--format", "robodk"}), cell::kExitUsage,
                  {"name a file with --out"});
}

TEST_F(CompensateFrames, RefusesTheArmOfAnotherRobotAndWarnsOfOneThatIsNotNamed) {
  arm_.serial = "ANOTHER";
  write("other.json", cell::arm_document(arm_));
  expect_one_line(compensate("targets.json", {}, "other.json"), cell::kExitRefused,
                  {"the serial number 'ANOTHER', and the cell's file has 'SIMULATED-TX90-0001'"});
  arm_.serial.reset();
  write("unnamed.json", cell::arm_document(arm_));
  const Finished unnamed = compensate("targets.json", {"--json"}, "unnamed.json");
  EXPECT_EQ(unnamed.exit_code, cell::kExitDone);
  EXPECT_THAT(unnamed.err, HasSubstr("has no serial number"));
}

}  // namespace
}  // namespace touchcal::testing
