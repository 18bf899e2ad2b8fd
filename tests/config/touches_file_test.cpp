#include "config/touches_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "calib_core/geometry/units.hpp"
#include "config/read_config.hpp"
#include "folder.hpp"

namespace cell {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Cell& edf() {
  static const Cell cell = read_cell(kSourceDir / "config/cells/edf/cell.json");
  return cell;
}

TouchesFile from_json(const std::string& bytes) {
  return touches_from_json("body", bytes, kTouchesSizeMax, edf());
}
TouchesFile from_csv(const std::string& lines) {
  return touches_from_csv("t.csv", std::string(kTouchesCsvHeader) + "\n" + lines, edf());
}

std::string document(const std::string& touches) {
  return R"({"schema":"touchcal/touches/2","arm":"tx90","touches":[)" + touches + "]}";
}

TEST(TouchesJson, IsReadAsTheContractShowsIt) {
  const TouchesFile file = from_json(document(R"({"plane":1,"joints_deg":[1.5,2.5,3.5,4.5,5.5,6.5]},
                  {"plane":4,"joints_deg":[0,0,0,0,0,0],"role":"held_out"},
                  {"plane":2,"joints_deg":[0,0,0,0,0,0],"role":"proof"},
                  {"plane":2,"joints_deg":[0,0,0,0,0,0],"role":"fit","noise_um":61.5})"));
  ASSERT_EQ(file.touches.size(), 4U);
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(file.touches[0].face, 0);
  EXPECT_EQ(file.touches[0].role, calib::TouchRole::kFit);
  for (int i = 0; i < calib::kJointCount; ++i) {
    EXPECT_DOUBLE_EQ(file.touches[0].joints[i], calib::radians_from_degrees(1.5 + i));
  }
  EXPECT_EQ(file.touches[1].face, 3);
  EXPECT_EQ(file.touches[1].role, calib::TouchRole::kHeldOut);
  EXPECT_EQ(file.touches[2].role, calib::TouchRole::kProof);
  EXPECT_EQ(file.touches[3].role, calib::TouchRole::kFit);
  EXPECT_EQ(file.touches[0].deviation_m, 0.0);
  EXPECT_DOUBLE_EQ(file.touches[3].deviation_m, 61.5e-6);
}

std::string with_references(const std::string& references) {
  return R"({"schema":"touchcal/touches/1","arm":"tx90","touches":[],"reference_touches":)" + references +
         "}";
}

/// A touch of the edf cell, with `moved_deg` added to a joint.
std::string reference(int joint = 1, double moved_deg = 0.0, int plane = 0) {
  static const TouchesFile made = read_touches(kSourceDir / "tests/data/table3-exact.touches.json", edf());
  const calib::Touch& touch = made.touches.front();
  nlohmann::json joints = nlohmann::json::array();
  for (int i = 0; i < calib::kJointCount; ++i)
    joints.push_back(calib::degrees_from_radians(touch.joints[i]) + (i + 1 == joint ? moved_deg : 0.0));
  return nlohmann::json{{"plane", plane == 0 ? touch.face + 1 : plane}, {"joints_deg", joints}}.dump();
}

std::string references(const std::vector<std::string>& made) {
  std::string list;
  for (const std::string& one : made) list += (list.empty() ? "" : ",") + one;
  return with_references("[" + list + "]");
}

TEST(TouchesJson, HasTheTouchesOfTheReferencePlaceInTheirOrder) {
  EXPECT_THAT(from_json(document("")).repeats.references, IsEmpty());
  const TouchesFile file = from_json(references({reference(), reference(1, 1e-3), reference(1, -1e-3)}));
  EXPECT_THAT(file.warnings, IsEmpty());
  ASSERT_EQ(file.repeats.references.size(), 3U);
  EXPECT_EQ(file.repeats.references[1].face, file.repeats.references[0].face);
  EXPECT_NEAR(file.repeats.references[1].joints[0] - file.repeats.references[0].joints[0],
              calib::radians_from_degrees(1e-3), 1e-12);
}

TEST(TouchesJson, ReferenceTouchesOfMoreThanOnePlaceAreRefusedWithTheirPointer) {
  const auto refusal = [](const std::string& one, std::size_t before = 1) {
    std::vector<std::string> made(before, reference());
    made.push_back(one);
    return error_of([&] { from_json(references(made)); });
  };
  const ConfigError posture = refusal(reference(4, 2.5));
  EXPECT_EQ(posture.pointer(), "/reference_touches/1/joints_deg");
  EXPECT_THAT(posture.message(), HasSubstr("joint 4 2.5 deg from the first reference touch; give touches of "
                                           "one place in one posture"));
  const ConfigError place = refusal(reference(1, 1.5), 3);
  EXPECT_EQ(place.pointer(), "/reference_touches/3/joints_deg");
  EXPECT_THAT(place.message(), HasSubstr("mm from where the first reference touch was made"));
  const ConfigError off = refusal(reference(3, 60.0), 0);
  EXPECT_EQ(off.pointer(), "/reference_touches/0/joints_deg");
  EXPECT_THAT(off.message(), HasSubstr("(by the nominal arm); correct the plane or the joints"));
  const int plane = from_json(references({reference()})).repeats.references.front().face + 1;
  EXPECT_EQ(refusal(reference(1, 0.0, plane % 4 + 1)).pointer(), "/reference_touches/1/plane");
}

TEST(TouchesJson, TooFewReferenceTouchesAreAWarning) {
  for (const auto& [made, said] : {std::pair{std::vector{reference()}, "1 reference touch says nothing"},
                                   std::pair{std::vector{reference(), reference(1, 1e-3)},
                                             "2 reference touches say nothing of noise and drift"}}) {
    EXPECT_THAT(from_json(references(made)).warnings, ElementsAre(HasSubstr(said)));
  }
  EXPECT_THAT(from_json(with_references("[]")).warnings, IsEmpty());
}

TEST(TouchesJson, CopiesAmongReferenceTouchesAreAWarning) {
  const std::string a = reference(), b = reference(1, 1e-3), c = reference(1, 2e-3);
  EXPECT_THAT(from_json(references({a, b, c, a})).warnings, IsEmpty()) << "an encoder's step may make that";
  EXPECT_THAT(from_json(references({a, b, c, a, a, a, b})).warnings,
              ElementsAre(HasSubstr("4 of 7 reference touches have the joints of another one")));
  EXPECT_THAT(
      from_json(references({a, a, a, a})).warnings,
      ElementsAre(HasSubstr("3 of 4 reference touches"), HasSubstr("1 reference touch says nothing")));
}

TEST(TouchesJson, AReferenceTouchOutsideTheRangesIsAWarningThatNamesIt) {
  Cell cell = edf();
  cell.arm.joint_ranges.upper[5] = -cell.arm.joint_ranges.upper[5];
  cell.arm.joint_ranges.lower[5] = 2.0 * cell.arm.joint_ranges.upper[5];
  const TouchesFile file = touches_from_json(
      "body", references({reference(), reference(1, 1e-3), reference(1, 2e-3)}), kTouchesSizeMax, cell);
  ASSERT_EQ(file.warnings.size(), 3U);
  EXPECT_THAT(file.warnings[2], HasSubstr("reference touch 3: joint 6 at"));
}

struct RefusedTouches {
  std::string bytes;
  std::string what;
};

TEST(TouchesJson, WhatIsWrongIsSaidWithItsPlace) {
  const std::vector<RefusedTouches> cases{
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6]},{"plane":1,"joints_deg":[1,2,3,4,5]})"),
       "body: /touches/1/joints_deg: wants 6 numbers, has 5; add the missing ones"},
      {document(R"({"plane":5,"joints_deg":[1,2,3,4,5,6]})"),
       "body: /touches/0/plane: is 5; give a whole number from 1 to 4"},
      {document(R"({"plane":0,"joints_deg":[1,2,3,4,5,6]})"), "/touches/0/plane: is 0"},
      {document(R"({"plane":1,"joints_deg":[1,2,null,4,5,6]})"), "/touches/0/joints_deg/2: is null"},
      {document(R"({"plane":1,"joints_deg":[1,2,NaN,4,5,6]})"), "not JSON near"},
      {document(R"({"plane":1,"joints_deg":[1,2,1e400,4,5,6]})"), "too large"},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"role":"fitted"})"),
       "/touches/0/role: is \"fitted\""},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":-20})"),
       "body: /touches/0/noise_um: is -20; give 0.001 to 5000"},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":0})"),
       "body: /touches/0/noise_um: is 0; give 0.001 to 5000"},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":1e-6})"),
       "/touches/0/noise_um: is 1e-06; give"},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":5000.1})"),
       "/touches/0/noise_um: is 5000.1; give"},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":null})"), "/touches/0/noise_um: is null"},
      {document(R"({"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":NaN})"), "not JSON near"},
      {document(R"({"plane":1,"joints_rad":[1,2,3,4,5,6]})"), "/touches/0/joints_rad: unknown key"},
      {with_references("7"), "body: /reference_touches: is a number"},
      {references({reference(), reference(1, 0.0, 2)}),
       "body: /reference_touches/1/plane: is 2 but the first reference touch is on plane 1"},
      {with_references(R"([{"plane":1,"joints_deg":[1,2,3,4,5,6],"role":"fit"}])"),
       "/reference_touches/0/role: unknown key"},
      {document("7"), "body: /touches/0: is a number; give an object"},
      {R"({"schema":"touchcal/touches/1","arm":"tx60","touches":[]})",
       "body: /arm: is \"tx60\" but the cell's arm is \"tx90\""},
      {R"({"schema":"touchcal/touches/5","arm":"tx90","touches":[]})",
       "this program reads \"touchcal/touches/4\""},
      {R"({"schema":"touchcal/touches/1","arm":"tx90","touches":[{"plane":1,"joints_deg":[1,2,3,4,5,6],"noise_um":61}]})",
       R"(/touches/0/noise_um: unknown key "noise_um" in a touches document of version 1; raise)"},
      {R"({"schema":"touchcal/touches/1","touches":[]})", "body: \"arm\" is missing; add it"},
      {R"({"schema":"touchcal/touches/1","arm":"tx90"})", "body: \"touches\" is missing; add it"},
      {"[]", "give an object with \"schema\":\"touchcal/touches/4\""},
  };
  for (const RefusedTouches& refused : cases) {
    EXPECT_THAT(error_of([&] { from_json(refused.bytes); }).what(), HasSubstr(refused.what)) << refused.bytes;
  }
}

TEST(TouchesJson, ALargerBodyThanItsCallerAllowsIsRefused) {
  const std::string bytes = document("");
  EXPECT_THAT(touches_from_json("body", bytes, bytes.size(), edf()).touches, IsEmpty());
  EXPECT_THAT(error_of([&] { touches_from_json("body", bytes, bytes.size() - 1, edf()); }).what(),
              HasSubstr("larger than"));
}

TEST(TouchesJson, TheTouchLimitIsReadAndOneMoreIsRefused) {
  const std::string touch = R"({"plane":1,"joints_deg":[0,0,0,0,0,0]})";
  std::string touches = touch;
  for (std::size_t i = 1; i < kTouchCountMax; ++i) touches += "," + touch;
  EXPECT_EQ(from_json(document(touches)).touches.size(), kTouchCountMax);
  EXPECT_THAT(error_of([&] { from_json(document(touches + "," + touch)); }).what(),
              HasSubstr("/touches: wants at most 100000 entries, has 100001"));
}

TEST(TouchesJson, AJointOutsideItsRangeIsAWarningThatNamesTheTouch) {
  const TouchesFile file = from_json(document(
      R"({"plane":1,"joints_deg":[180,147.5,-145,270,140,-270]},{"plane":1,"joints_deg":[0,147.6,0,0,-115.5,0]})"));
  EXPECT_EQ(file.touches.size(), 2U);
  EXPECT_THAT(file.warnings, ElementsAre("touch 2: joint 2 at 147.6 deg is outside -130 to 147.5, "
                                         "joint 5 at -115.5 deg is outside -115 to 140"));
}

TEST(TouchesJson, EndlessWarningsAreCounted) {
  const std::string touch = R"({"plane":1,"joints_deg":[999,0,0,0,0,0]})";
  std::string touches = touch;
  for (int i = 1; i < 250; ++i) touches += "," + touch;
  const TouchesFile file = from_json(document(touches));
  ASSERT_EQ(file.warnings.size(), 101U);
  EXPECT_EQ(file.warnings.back(), "150 more touches have joints outside their ranges");
}

TEST(TouchesFile, HoldsMillimetresWhereAJointSlides) {
  Cell cell = edf();
  cell.arm.model.joint_types[2] = calib::JointType::kPrismatic;
  cell.arm.joint_ranges.lower[2] = -0.1;
  cell.arm.joint_ranges.upper[2] = 0.2;
  const std::string csv = std::string(kTouchesCsvHeader) + "\n1,1.5,2.5,250.5,4.5,5.5,6.5\n";
  const std::string json = document(R"({"plane":1,"joints_deg":[1.5,2.5,250.5,4.5,5.5,6.5]})");
  for (const TouchesFile& file :
       {touches_from_csv("t.csv", csv, cell), touches_from_json("body", json, kTouchesSizeMax, cell)}) {
    EXPECT_DOUBLE_EQ(file.touches.at(0).joints[2], 0.2505);
    EXPECT_DOUBLE_EQ(file.touches.at(0).joints[1], calib::radians_from_degrees(2.5));
    EXPECT_THAT(file.warnings, ElementsAre("touch 1: joint 3 at 250.5 mm is outside -100 to 200"));
  }
}

TEST(TouchesCsv, GivesTheSameTouchesAsJson) {
  const TouchesFile json = from_json(document(
      R"({"plane":1,"joints_deg":[1.5,-2.5,3.5e0,4.5,5.5,6.5]},{"plane":4,"joints_deg":[10,20,30,200,50,6.5]})"));
  const std::string header(kTouchesCsvHeader);
  const std::string first = "1,1.5,-2.5,3.5e0,4.5,5.5,6.5";
  const std::string second = "4, 10, 20 ,30,200,50,6.5";
  for (const std::string& bytes :
       {header + "\n" + first + "\n" + second + "\n", header + "\r\n" + first + "\r\n" + second + "\r\n",
        header + "\n" + first + "\n" + second, header + "\n" + first + "\n\n" + second + "\n\n"}) {
    const TouchesFile csv = touches_from_csv("t.csv", bytes, edf());
    ASSERT_EQ(csv.touches.size(), 2U) << bytes;
    for (std::size_t i = 0; i < csv.touches.size(); ++i) {
      EXPECT_EQ(csv.touches[i].face, json.touches[i].face);
      EXPECT_EQ(csv.touches[i].joints, json.touches[i].joints);
      EXPECT_EQ(csv.touches[i].role, calib::TouchRole::kFit);
    }
  }
}

TEST(TouchesCsv, WhatIsWrongIsSaidWithItsLine) {
  const std::vector<RefusedTouches> cases{
      {"1,1,2,3,4,5,6\n1,1,2,3,4,5\n", "t.csv: line 3: wants a plane and 6 joints, has 6 values"},
      {"1,1,2,3,4,5,6,7\n", "line 2: wants a plane and 6 joints, has 8 values"},
      {"1;1;2;3;4;5;6\n", "line 2: wants a plane and 6 joints, has 1 values"},
      {"5,1,2,3,4,5,6\n", "line 2: plane is \"5\"; give a whole number from 1 to 4"},
      {"1.5,1,2,3,4,5,6\n", "line 2: plane is \"1.5\""},
      {"1,1,2,nan,4,5,6\n", "line 2: joint 3 is \"nan\"; give a finite number"},
      {"1,1,2,3,inf,5,6\n", "line 2: joint 4 is \"inf\""},
      {"1,1,2,3,4,1e999,6\n", "line 2: joint 5 is \"1e999\""},
      {"1,1,2,3,4,1e308,6\n", "line 2: joint 5 is 1e+308; give -100000 to 100000"},
      {"1,1,2,3,4,5,\n", "line 2: joint 6 is \"\""},
      {"1,1,2,3,4,5,6 deg\n", "line 2: joint 6 is \"6 deg\""},
      {"1,1,2,3,4,5,6\r\n\r\n9,1,2,3,4,5,6\r\n", "line 4: plane is \"9\""},
  };
  for (const RefusedTouches& refused : cases) {
    EXPECT_THAT(error_of([&] { from_csv(refused.bytes); }).what(), HasSubstr(refused.what)) << refused.bytes;
  }
  EXPECT_THAT(error_of([&] { touches_from_csv("t.csv", "1,1,2,3,4,5,6\n", edf()); }).what(),
              HasSubstr("t.csv: line 1: the header is missing"));
}

TEST(TouchesCsv, AHeaderAloneIsNoTouches) {
  EXPECT_THAT(from_csv("").touches, IsEmpty());
  EXPECT_THAT(touches_from_csv("t.csv", kTouchesCsvHeader, edf()).touches, IsEmpty());
}

TEST(TouchesFile, IsTakenForCsvByItsNameOrItsHeader) {
  const Folder folder;
  const std::string csv = std::string(kTouchesCsvHeader) + "\n2,1,2,3,4,5,6\n";
  EXPECT_EQ(read_touches(folder.write("a.csv", csv), edf()).touches.size(), 1U);
  EXPECT_EQ(read_touches(folder.write("a.txt", csv), edf()).touches.size(), 1U);
  EXPECT_EQ(read_touches(folder.write("a.json", document("")), edf()).touches.size(), 0U);
  const auto file = folder.write("b.csv", document(""));
  EXPECT_EQ(std::string(error_of([&] { read_touches(file, edf()); }).what()),
            file.string() + ": line 1: the header is missing; begin with " + std::string(kTouchesCsvHeader));
}

TEST(TouchesFile, AMissingFileIsNamed) {
  EXPECT_EQ(std::string(error_of([&] { read_touches("/nowhere/t.json", edf()); }).what()),
            "/nowhere/t.json: there is no such file; check the path");
}

}  // namespace
}  // namespace cell
