#include "service/offline_programs/data_filter.hpp"

#include <gmock/gmock.h>

#include "service/base/digest.hpp"
#include "service/offline_programs/trsf_pose.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string filter_refusal(const std::string& data, const std::string& list) {
  return error_of([&] { filtered(data, list, unchanged()); }).what();
}

const std::string kInWorld = "fatherId=\"world[0]\"";

TEST(DataFilter, WritesThePointsAndJointsThatAreMarkedOfflineAndNoOthers) {
  const auto data = [](const std::string& point, const std::string& joint) {
    return kBom + new_data("    <!-- <Value key=\"0\" x=\"1\" /> of pA -->\n" +
                           variable("pA", "pointRx", point) + variable("jA", "jointRx", joint) +
                           variable("pTaught", "pointRx", value("key=\"0\" x=\"1\" " + kInWorld)) +
                           variable("jHome", "jointRx", value("key=\"0\" j1=\"1\"")) +
                           variable("trA", "trsf", value("key=\"0\" x=\"1\"")) +
                           variable("tA", "tool", value("key=\"0\" x=\"1\" fatherId=\"flange[0]\"")));
  };
  const FilteredData found =
      filtered(data(value("key=\"0\" x=\"1\" y=\"20.50\" rz=\"180\" " + kInWorld),
                    value("key=\"0\" j2=\"-90\" j6=\"1\"")),
               "pA offline grip\njA offline\npTaught taught\njHome leave\n", shifted_by({0.25, 0, -1.5}));
  EXPECT_EQ(found.text,
            data(value("key=\"0\" x=\"1.25\" y=\"20.50\" z=\"-1.5\" rz=\"180\" " + kInWorld),
                 value("key=\"0\" j1=\"0.25\" j2=\"-89.5\" j3=\"0.75\" j4=\"1\" j5=\"1.25\" j6=\"2.5\"")));
  ASSERT_EQ(found.values.size(), 2U);
  EXPECT_EQ(found.values[0].name, "pA[0]");
  EXPECT_EQ(found.values[0].line, 6);
  EXPECT_NEAR(found.values[0].moved_mm, std::hypot(0.25, 1.5), 1e-12);
  EXPECT_THAT(found.values[0].inserted, ElementsAre("z"));
  EXPECT_THAT(found.values[1].inserted, ElementsAre("j1", "j3", "j4", "j5"));
  EXPECT_EQ(found.count(CorrectionStatus::kOk), 2U);
  EXPECT_EQ(found.mark.result_sha256, sha256_hex(found.text));
  EXPECT_NE(found.mark.original_sha256, found.mark.result_sha256);
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST(DataFilter, AsksInTheWorldAndWritesInThePointsOwnFrame) {
  const auto data = [](const std::string& point) {
    return new_data(
        variable("fTable", "frame", value("key=\"0\" x=\"100\" rz=\"90\" " + kInWorld)) +
        variable("fPiece", "frame", value("key=\"1\" y=\"50\" rz=\"90\" fatherId=\"fTable[0]\""), "2") +
        variable("pA", "pointRx", value(point + " wrist=\"wpositive\" fatherId=\"fPiece[1]\"")));
  };
  std::vector<OfflineTarget> asked;
  const Corrector corrector = [&](const OfflineTarget& target) {
    asked.push_back(target);
    return shifted_by({1, 0, 0})(target);
  };
  const FilteredData found = filtered(data("key=\"0\" x=\"10\""), "pA offline gripper", corrector);
  EXPECT_EQ(found.text, data("key=\"0\" x=\"9\"")) << "turned by half: the world's x is the piece's -x";
  ASSERT_EQ(asked.size(), 1U);
  EXPECT_EQ(asked[0].name, "pA[0]");
  EXPECT_EQ(asked[0].tool, "gripper");
  const auto& place = std::get<OfflinePose>(asked[0].place);
  EXPECT_TRUE(place.world_from_tool.translation().isApprox(Eigen::Vector3d(0.04, 0, 0)));
  EXPECT_EQ(place.posture.wrist, WristWord::kPositive);
  EXPECT_THAT(found.notes, ElementsAre(HasSubstr("fPiece[1] is taken as it is stored")));
}

TEST(DataFilter, TurnsAPointAndKeepsTheWritingOfItsAngles) {
  const auto data = [](const std::string& rz) {
    return new_data(
        variable("pA", "pointRx", value("key=\"0\" rx=\"-180\" ry=\"10\" rz=\"" + rz + "\" " + kInWorld)));
  };
  const Corrector corrector = [](const OfflineTarget& target) {
    Correction correction{.status = CorrectionStatus::kOk};
    correction.world_from_tool = std::get<OfflinePose>(target.place).world_from_tool *
                                 Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ());
    return correction;
  };
  EXPECT_EQ(filtered(data("20"), "pA offline", corrector).text, data("20.057296"));
}

TEST(DataFilter, LeavesWhatTheCorrectorRefusesAndSaysWhy) {
  const std::string data = new_data(variable(
      "pA", "pointRx", value("key=\"0\" x=\"1\" " + kInWorld) + value("key=\"1\" " + kInWorld), "4"));
  const Corrector corrector = [](const OfflineTarget& target) {
    Correction correction = shifted_by({0, 0, 3})(target);
    correction.status = target.name == "pA[0]" ? CorrectionStatus::kRefused : CorrectionStatus::kWarned;
    correction.reason = "the wrist is stretched";
    return correction;
  };
  const FilteredData found = filtered(data, "pA offline", corrector);
  std::string wanted = data;
  wanted.replace(wanted.find("key=\"1\""), 7, "key=\"1\" z=\"3\"");
  EXPECT_EQ(found.text, wanted);
  EXPECT_EQ(found.count(CorrectionStatus::kRefused), 1U);
  EXPECT_EQ(found.count(CorrectionStatus::kWarned), 1U);
  EXPECT_EQ(found.values[0].reason, "the wrist is stretched");
  EXPECT_EQ(found.values[0].moved_mm, 0.0);
  EXPECT_THAT(found.notes, ElementsAre("pA: 2 of 4 elements have no value in the file, are 0 and stay so"));
}

TEST(DataFilter, CountsInTheUnitOfTheApplication) {
  const auto data = [](const std::string& x) {
    return new_data(variable("pA", "pointRx", value("key=\"0\" x=\"" + x + "\" " + kInWorld)));
  };
  EXPECT_EQ(filtered(data("10"), "pA offline", shifted_by({2.54, 0, 0}), 25.4).text, data("10.1"));
}

TEST(DataFilter, FiltersCollectionsByTheirKeys) {
  const std::string data = new_data(
      "<Data name=\"pA\" access=\"public\" xsi:type=\"collection\" type=\"pointRx\">\n"
      "<Value key=\"left &amp; right\" fatherId=\"world[0]\"/></Data>\n");
  const FilteredData found = filtered(data, "pA offline", shifted_by({1, 0, 0}));
  EXPECT_THAT(found.text, HasSubstr("<Value key=\"left &amp; right\" x=\"1\" fatherId=\"world[0]\"/>"));
  EXPECT_EQ(found.values.at(0).name, "pA[\"left & right\"]");
}

TEST(DataFilter, RefusesAVariableThatNobodyDecidedAbout) {
  EXPECT_EQ(
      filter_refusal(new_data(variable("pA", "pointRx", "")), ""),
      "cell.dtx:4: \"pA\" is a pointRx and is not in points.list; write there pA offline, taught or leave");
  EXPECT_THAT(filter_refusal(new_data(variable("jA", "jointRx", "")), ""),
              HasSubstr("write there jA offline, taught or leave"));
  EXPECT_THAT(filter_refusal(new_data(variable("pS", "pointRs", "")), ""), HasSubstr("write there pS leave"));
  EXPECT_EQ(filter_refusal(new_data(variable("qA", "partType", "")), ""),
            "cell.dtx:4: \"qA\" is a partType, which is no type of VAL3 and may hold points, and is not in "
            "points.list; write there qA leave");
  for (const std::string type : {"num", "tool", "frame", "trsf", "mdesc", "dio", "configRx"})
    EXPECT_NO_THROW(filtered(new_data(variable("x", type, "")), "", unchanged())) << type;
}

TEST(DataFilter, RefusesAListThatDoesNotFitTheFile) {
  EXPECT_EQ(filter_refusal(new_data(variable("pA", "pointRx", "")), "pA leave\npB leave\n"),
            "points.list:2: \"pB\" is no variable of cell.dtx; correct the name, or remove the line");
  for (const std::string type : {"frame", "tool", "trsf", "num", "pointRs", "partType"})
    EXPECT_EQ(filter_refusal(new_data(variable("x", type, "")), "x offline"),
              "points.list:1: \"x\" is a " + type +
                  ": only points and joints of six axes are filtered; write x leave");
}

TEST(DataFilter, RefusesAPointWhosePlaceIsNotKnown) {
  EXPECT_EQ(filter_refusal(new_data(variable("pA", "pointRx", value("key=\"0\" x=\"1\""))), "pA offline"),
            "cell.dtx:5: pA[0] is given in no frame; give it one, or mark pA leave");
  const std::string far = new_data(variable("pA", "pointRx", value("key=\"0\" fatherId=\"lib:fA[0]\"")));
  EXPECT_EQ(
      filter_refusal(far, "pA offline"),
      "cell.dtx:5: pA[0]: the frame fA is in the library lib, whose file is another; copy the frame into "
      "this file, or mark pA leave");
  EXPECT_EQ(filtered(far, "pA leave", unchanged()).text, far);
}

TEST(DataFilter, RefusesItsOwnResult) {
  const std::string data = new_data(variable("pA", "pointRx", value("key=\"0\" x=\"1\" " + kInWorld)));
  const FilteredData once = filtered(data, "pA offline\n", shifted_by({1, 0, 0}));
  const std::string list = with_filtered_mark("pA offline\n", once.mark);
  EXPECT_THAT(std::string(error_of([&] { filtered(once.text, list, unchanged()); }).what()),
              HasSubstr("cell.dtx: is filtered already"));
  EXPECT_EQ(filtered(data, list, shifted_by({1, 0, 0})).text, once.text)
      << "the original may be filtered again";
}

TEST(DataFilter, RefusesItsOwnPointsWhereAnEditorHasSavedThemAnew) {
  const auto data = [](const std::string& attributes) {
    return new_data(variable("pA", "pointRx", value(attributes + kInWorld)) +
                    variable("pB", "pointRx", value("key=\"0\" x=\"1\" " + kInWorld)));
  };
  const std::string marks = "pA offline\npB leave\n";
  const FilteredData once = filtered(data("key=\"0\" x=\"1\" "), marks, shifted_by({1, 0, 0}));
  const std::string list = with_filtered_mark(marks, once.mark);
  EXPECT_EQ(
      filter_refusal(data("key=\"0\" y=\"0\" x=\"2.0\" "), list),
      "cell.dtx: pA holds what a filter made, says points.list: a second filter would correct its points "
      "twice; give the original, or mark pA leave");
  EXPECT_NO_THROW(filtered(data("key=\"0\" x=\"2.5\" "), list, unchanged()));
  const std::string leave = list.substr(list.find("#")) + "pA leave\npB leave\n";
  EXPECT_NO_THROW(filtered(data("key=\"0\" x=\"2.0\" "), leave, unchanged()));
  EXPECT_THAT(filtered(data("key=\"0\" x=\"1\" "), marks, unchanged()).mark.points, IsEmpty())
      << "nothing was corrected";
}

TEST(DataFilter, RefusesAPointInAFrameThatTheListSaysWasTouchedWithTheNominalArm) {
  const std::string data = new_data(variable("fA", "frame", value("key=\"0\" x=\"1\" " + kInWorld)) +
                                    variable("pA", "pointRx", value("key=\"0\" fatherId=\"fA[0]\"")));
  EXPECT_EQ(
      filter_refusal(data, "pA offline\nfA taught\n"),
      "cell.dtx:8: pA[0]: the frame fA was touched with the nominal arm, says points.list (taught), and "
      "holds that arm's errors; touch it again with the calibrated arm and mark it leave, or mark pA "
      "leave");
  EXPECT_THAT(filtered(data, "pA offline\nfA leave\n", unchanged()).notes, IsEmpty());
  EXPECT_THAT(filtered(data, "pA offline\n", unchanged()).notes, ElementsAre(HasSubstr("fA[0] is taken as")));
}

TEST(DataFilter, RefusesBrokenFilesAndFilesThatAreTooLarge) {
  const std::string data = new_data(variable("pA", "pointRx", value("key=\"0\" " + kInWorld)));
  EXPECT_THAT(filter_refusal(data.substr(0, data.size() / 2), "pA offline"), HasSubstr("is no whole XML"));
  EXPECT_THAT(filter_refusal(data + std::string(100'000'000, ' '), "pA offline"),
              HasSubstr("more than the 16777216 that are read"));
}

}  // namespace
}  // namespace cell
