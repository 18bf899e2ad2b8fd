#include "config/targets_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "folder.hpp"

namespace cell {
namespace {

using testing::HasSubstr;

const std::string kJoints = R"("joints_deg":[20,30,60,10,50,-20])";
const std::string kPose =
    R"("position_mm":[450,120,300],"rotation_deg":[180,0,90],"near_joints_deg":[15,40,80,0,60,0])";

std::string document_of(const std::string& targets) {
  return R"({"schema":"touchcal/targets/1","tool":"gripper","targets":[)" + targets + "]}";
}
std::string named(const std::string& name, const std::string& wanted = kJoints) {
  return R"({"name":")" + name + "\"," + wanted + "}";
}
TargetsFile targets_of_json(const std::string& targets) {
  return targets_from_json("t.json", document_of(targets), kTargetsSizeMax);
}
TargetsFile targets_of_csv(const std::string& lines) {
  return targets_from_csv("t.csv", std::string(kTargetsCsvHeader) + "\n" + lines);
}

TEST(TargetsJson, AreJointsOrPosesOfOneTool) {
  const TargetsFile file =
      targets_of_json(named("pick") + "," + named("leave it") + "," + named("put", kPose) + "," +
                      named("lay", kPose + R"(,"frame":"world")"));
  EXPECT_EQ(file.tool, "gripper");
  EXPECT_TRUE(file.names_tool);
  ASSERT_EQ(file.targets.size(), 4U);
  EXPECT_EQ(file.targets[0].name, "pick");
  const auto& joints = std::get<calib::JointVector>(file.targets[0].wanted);
  EXPECT_DOUBLE_EQ(joints[5], calib::radians_from_degrees(-20.0));
  const auto& pose = std::get<PoseTarget>(file.targets[2].wanted);
  EXPECT_TRUE(pose.world_from_tool.translation().isApprox(Eigen::Vector3d(0.45, 0.12, 0.3)));
  // Rot(x, 180) Rot(z, 90): x of the tool is Rot(x, 180) y.
  EXPECT_TRUE(pose.world_from_tool.linear().col(0).isApprox(Eigen::Vector3d(0.0, -1.0, 0.0), 1e-12));
  EXPECT_DOUBLE_EQ(pose.near_joints[2], calib::radians_from_degrees(80.0));
}

struct Refusal {
  std::string targets, pointer, part;
};

class RefusedTargets : public testing::TestWithParam<Refusal> {};

TEST_P(RefusedTargets, NameTheirPlaceAndTheRemedy) {
  const auto& [targets, pointer, part] = GetParam();
  const ConfigError error = error_of([&] { targets_of_json(targets); });
  EXPECT_EQ(error.source(), "t.json");
  EXPECT_EQ(error.pointer(), pointer);
  EXPECT_THAT(error.message(), HasSubstr(part));
}
INSTANTIATE_TEST_SUITE_P(
    Json, RefusedTargets,
    testing::Values(
        Refusal{"", "/targets", "1"},
        Refusal{R"({"joints_deg":[1,2,3,4,5,6]})", "/targets/0", "\"name\" is missing"},
        Refusal{named(""), "/targets/0/name", "empty"},
        Refusal{named("a") + "," + named("a"), "/targets/1/name", "earlier target; give another"},
        Refusal{named(std::string(kTargetNameSizeMax + 1, 'a')), "/targets/0/name", "at most 64"},
        Refusal{named("a,b"), "/targets/0/name", "leave commas and quotes out"},
        Refusal{named(R"(a\"b)"), "/targets/0/name", "leave commas and quotes out"},
        Refusal{named(" a"), "/targets/0/name", "leave the spaces at its ends out"},
        Refusal{named("a", R"("joints_deg":[1,2,3,4,5])"), "/targets/0/joints_deg", "6 numbers"},
        Refusal{named("a", R"("joints_deg":[1,2,3,4,5,1e9])"), "/targets/0/joints_deg/5", "100000"},
        Refusal{named("a", kJoints + "," + kPose), "/targets/0/position_mm", "joints or a pose, not both"},
        Refusal{named("a", kJoints + R"(,"frame":"world")"), "/targets/0/frame",
                "joints or a pose, not both"},
        Refusal{R"({"name":"a"})", "/targets/0", "has no pose; give \"joints_deg\""},
        Refusal{named("a", R"("position_mm":[1,2,3],"rotation_deg":[1,2,3])"), "/targets/0",
                "\"near_joints_deg\" is missing"},
        Refusal{named("a", R"("position_mm":[1,2,3],"near_joints_deg":[1,2,3,4,5,6])"), "/targets/0",
                "\"rotation_deg\" is missing"},
        Refusal{named("a", kPose + R"(,"frame":"pallet")"), "/targets/0/frame",
                "give one of world, or add it to the \"target_frames\""},
        Refusal{named("a", kJoints + R"(,"speed":1)"), "/targets/0/speed", "unknown key"}));

TEST(TargetsJson, WithoutAToolOrOfAnotherSchemaAreRefused) {
  const auto refusal = [](const std::string& text) {
    return error_of([&] { targets_from_json("t.json", text, kTargetsSizeMax); });
  };
  EXPECT_THAT(refusal(R"({"schema":"touchcal/targets/1","targets":[]})").message(),
              HasSubstr("\"tool\" is missing"));
  EXPECT_EQ(refusal(R"({"schema":"touchcal/targets/3","tool":"stylus","targets":[]})").pointer(), "/schema");
  EXPECT_THAT(error_of([] { targets_from_json("t.json", document_of(named("a")), 20); }).message(),
              HasSubstr("20"));
}

std::string second_document_of(const std::string& targets, const std::string& more = "") {
  return R"({"schema":"touchcal/targets/2","tool":"gripper",)" + more + R"("targets":[)" + targets + "]}";
}
ConfigError second_refusal(const std::string& targets, const std::string& more = "") {
  return error_of([&] { targets_from_json("t.json", second_document_of(targets, more), kTargetsSizeMax); });
}

TEST(TargetsJson, OfVersion2MayBeReachedOnAStraightLine) {
  const TargetsFile file =
      targets_from_json("t.json",
                        second_document_of(named("a") + "," + named("b", kJoints + R"(,"move":"line")") +
                                               "," + named("c", kPose + R"(,"move":"line")") + "," +
                                               named("d", kJoints + R"(,"move":"joint")"),
                                           R"("line_max_mm":0.05,)"),
                        kTargetsSizeMax);
  EXPECT_TRUE(file.may_have_lines());
  EXPECT_DOUBLE_EQ(file.line_max_m.value(), 5e-5);
  std::vector<TargetMove> moves;
  for (const Target& target : file.targets) moves.push_back(target.move);
  EXPECT_THAT(moves, testing::ElementsAre(TargetMove::kJoint, TargetMove::kLine, TargetMove::kLine,
                                          TargetMove::kJoint));
  const TargetsFile plain = targets_of_json(named("a"));
  EXPECT_FALSE(plain.may_have_lines() || plain.line_max_m);
  EXPECT_FALSE(targets_of_csv("a,1,2,3,4,5,6\n").may_have_lines());
}

TEST(TargetsJson, RefuseALineWithoutAStartAnUnknownMoveAndAVersionWithoutLines) {
  const std::string line = kJoints + R"(,"move":"line")";
  const ConfigError first = second_refusal(named("a", line));
  EXPECT_EQ(first.pointer(), "/targets/0/move");
  EXPECT_THAT(first.message(), HasSubstr("give the start of the line as a target before it"));
  const ConfigError unknown = second_refusal(named("a") + "," + named("b", kJoints + R"(,"move":"arc")"));
  EXPECT_EQ(unknown.pointer(), "/targets/1/move");
  EXPECT_THAT(unknown.message(), HasSubstr(R"(is "arc"; give "line" or "joint")"));
  const ConfigError early = error_of([&] { targets_of_json(named("a") + "," + named("b", line)); });
  EXPECT_EQ(early.pointer(), "/targets/1/move");
  EXPECT_THAT(early.message(), HasSubstr("unknown key \"move\" in a targets document of version 1; raise"));
}

TEST(TargetsJson, RefuseALimitThatNoLineCanHoldOrNoneNeeds) {
  for (const char* limit : {"-0.02", "0", "0.0009", "11", "1e300", "null", "\"0.02\""}) {
    EXPECT_EQ(second_refusal(named("a"), std::string("\"line_max_mm\":") + limit + ",").pointer(),
              "/line_max_mm")
        << limit;
  }
}

TEST(TargetsCsv, AreJointsOfTheStylus) {
  const TargetsFile file = targets_of_csv("pick,20,30,60,10,50,-20\r\n\nprise \xc3\xa9, 1,2,3,4,5,6");
  EXPECT_EQ(file.tool, kStylusTool);
  EXPECT_FALSE(file.names_tool);
  ASSERT_EQ(file.targets.size(), 2U);
  EXPECT_EQ(file.targets[1].name, "prise \xc3\xa9");
  EXPECT_DOUBLE_EQ(std::get<calib::JointVector>(file.targets[1].wanted)[0], calib::radians_from_degrees(1.0));
}

TEST(TargetsCsv, WhatIsWrongIsSaidWithItsLine) {
  const std::string right = "a,1,2,3,4,5,6\n";
  for (const auto& [lines, said] :
       {std::pair{right + "b,1,2,3,4,5", "line 3: wants a name and 6 joints, has 6 values"},
        std::pair{right + "b,1,2,3,4,5,x", "line 3: joint 6 is \"x\"; give a finite number"},
        std::pair{right + "b,1,2,3,4,5,nan", "line 3: joint 6 is \"nan\""},
        std::pair{right + "b,1,2,3,4,5,1e7", "line 3: joint 6 is 10000000; give -100000 to 100000"},
        std::pair{right + right, "line 3: the name is \"a\" as that of an earlier target"},
        std::pair{right + ",1,2,3,4,5,6", "line 3: the name is empty"},
        std::pair{right + "b\tc,1,2,3,4,5,6", "line 3: the name is no text"},
        std::pair{right + "\xff,1,2,3,4,5,6", "line 3: the name is no text"},
        std::pair{std::string("\n"), "there is no target"}}) {
    EXPECT_THAT(error_of([&] { targets_of_csv(lines); }).message(), HasSubstr(said)) << lines;
  }
  EXPECT_THAT(error_of([] { targets_from_csv("t.csv", "a,1,2,3,4,5,6\n"); }).message(),
              HasSubstr("line 1: the header is missing; begin with name,j1_deg"));
}

TEST(TargetsCsv, OfMoreThanAHundredThousandLinesAreRefused) {
  std::string lines;
  for (std::size_t i = 0; i < kTargetCountMax; ++i) lines += "p" + std::to_string(i) + ",1,2,3,4,5,6\n";
  EXPECT_EQ(targets_of_csv(lines).targets.size(), kTargetCountMax);
  EXPECT_THAT(error_of([&] { targets_of_csv(lines + "one,1,2,3,4,5,6\n"); }).message(),
              HasSubstr("more than 100000 targets; split the file"));
}

TEST(TargetsJson, MayBeInAFrameOfTheCell) {
  TargetFrames frames;
  frames["pallet"]
      .world_from_frame.translate(Eigen::Vector3d(0.1, 0, 0))
      .rotate(Eigen::AngleAxisd(calib::radians_from_degrees(90.0), Eigen::Vector3d::UnitZ()));
  frames["fixture"].is_touched_nominally = true;
  const auto in_frame = [&](const std::string& frame) {
    return targets_from_json("t.json", document_of(named("a", kPose + R"(,"frame":")" + frame + '"')),
                             kTargetsSizeMax, frames);
  };
  const TargetsFile file = in_frame("pallet");
  const auto& pose = std::get<PoseTarget>(file.targets.at(0).wanted);
  EXPECT_TRUE(pose.world_from_tool.translation().isApprox(Eigen::Vector3d(-0.02, 0.45, 0.3)));
  EXPECT_TRUE(pose.world_from_tool.linear().col(0).isApprox(Eigen::Vector3d(1.0, 0.0, 0.0), 1e-12));
  const ConfigError unknown = error_of([&] { in_frame("palet"); });
  EXPECT_EQ(unknown.pointer(), "/targets/0/frame");
  EXPECT_THAT(unknown.message(), HasSubstr("give one of world, fixture, pallet"));
  EXPECT_THAT(error_of([&] { in_frame("fixture"); }).message(), HasSubstr("touched with the nominal arm"));
}

const std::string kRobodkLine = "Target 1, 450, 120.5, 300, 180, 0, 90, 15, 40, 80, 0, 60, 0\n";

TEST(TargetsRobodk, ArePosesWithTheJointsThatSayTheirConfiguration) {
  const Folder folder;
  for (const std::string& header :
       {std::string(kRobodkHeader) + "\n", "# said\n# of it\n" + std::string(kRobodkHeader) + "\r\n",
        std::string("Name,X,Y,Z,Rx,Ry,Rz,J1,J2,J3,J4,J5,J6\n")}) {
    const TargetsFile file = read_targets(folder.write("t.csv", header + kRobodkLine));
    EXPECT_TRUE(file.leaves_frame_open);
    EXPECT_FALSE(file.names_tool);
    ASSERT_EQ(file.targets.size(), 1U);
    EXPECT_EQ(file.targets[0].name, "Target 1");
    const auto& pose = std::get<PoseTarget>(file.targets[0].wanted);
    EXPECT_TRUE(pose.world_from_tool.translation().isApprox(Eigen::Vector3d(0.45, 0.1205, 0.3)));
    EXPECT_TRUE(pose.world_from_tool.linear().col(0).isApprox(Eigen::Vector3d(0.0, -1.0, 0.0), 1e-12));
    EXPECT_DOUBLE_EQ(pose.near_joints[4], calib::radians_from_degrees(60.0));
  }
}

TEST(TargetsRobodk, WithoutJointsOrWithAWrongNumberNameWhatIsMissing) {
  const Folder folder;
  const auto refusal = [&](const std::string& text) {
    return std::string(error_of([&] { read_targets(folder.write("t.csv", text)); }).what());
  };
  EXPECT_THAT(refusal("Name, X, Y, Z, Rx, Ry, Rz\na, 1, 2, 3, 4, 5, 6\n"),
              HasSubstr("add the columns J1 to J6"));
  EXPECT_THAT(refusal("Name, X, Y, Z, Rx, Ry, Rz, J1\na, 1, 2, 3, 4, 5, 6, 7\n"),
              HasSubstr("line 1: the header is missing; begin with Name, X, Y, Z, Rx, Ry, Rz, J1, J2"));
  const std::string head = "# one\n" + std::string(kRobodkHeader) + "\n";
  EXPECT_THAT(refusal(head + "a, 1, 2, 3, 4, 5, x, 1, 2, 3, 4, 5, 6\n"), HasSubstr("line 3: Rz is \"x\""));
  EXPECT_THAT(refusal(head + "a, 1, 2, 3\n"),
              HasSubstr("line 3: wants a name, a pose of 6 numbers and 6 joints"));
  EXPECT_THAT(refusal(head + kRobodkLine + kRobodkLine),
              HasSubstr("line 4: the name is \"Target 1\" as that"));
  EXPECT_THAT(refusal(head), HasSubstr("there is no target"));
}

TEST(TargetsFile, IsTakenForCsvByItsNameOrItsHeader) {
  const Folder folder;
  const std::string csv = std::string(kTargetsCsvHeader) + "\na,1,2,3,4,5,6\n";
  EXPECT_FALSE(read_targets(folder.write("t.csv", csv)).names_tool);
  EXPECT_FALSE(read_targets(folder.write("t.txt", csv)).names_tool);
  EXPECT_TRUE(read_targets(folder.write("t.json", document_of(named("a")))).names_tool);
  EXPECT_THAT(error_of([&] { read_targets(folder.path() / "missing.json"); }).source(),
              HasSubstr("missing.json"));
}

}  // namespace
}  // namespace cell
