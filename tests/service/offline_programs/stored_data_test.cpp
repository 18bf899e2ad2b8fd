#include "service/offline_programs/stored_data.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

std::string data_refusal(const std::string& bytes) {
  return error_of([&] {
           const XmlText xml("cell.dtx", bytes);
           read_stored_data(xml);
         })
      .what();
}

TEST(StoredData, KnowsKindsKeysFathersAndPostures) {
  const XmlText xml(
      "cell.dtx",
      new_data(variable("pPick", "pointRx",
                        value("key=\"2\" x=\"1\" rz=\"-6.5\" shoulder=\"righty\" elbow=\"epositive\" "
                              "wrist=\"wfree\" fatherId=\"fPiece[1]\"") +
                            value("key=\"0\""),
                        "3") +
               variable("jHome", "jointRx", value("key=\"0\" j5=\"90\"")) +
               variable("pGrid", "pointRx", value("key=\"1 2\" fatherId=\"lib:fBase\""), "2 3") +
               variable("nCount", "num", value("key=\"0\" value=\"what it wants\"")) +
               variable("tGrip", "tool", value("key=\"0\" z=\"1\" fatherId=\"flange[0]\"")) +
               variable("pScara", "pointRs", "") + variable("qPart", "partType", "") +
               "<Data name=\"pByName\" xsi:type=\"collection\" type=\"pointRx\"><Value key=\"left hand\" "
               "x=\"4\"/></Data>"));
  const StoredData data = read_stored_data(xml);
  const auto of = [&](const char* name) { return data.variables.at(data.places.at(name)); };
  const StoredVariable pick = of("pPick");
  EXPECT_EQ(pick.kind, StoredKind::kPoint);
  EXPECT_EQ(pick.size, 3U);
  ASSERT_EQ(pick.elements.size(), 2U);
  EXPECT_EQ(pick.elements[0].key, "2");
  EXPECT_EQ(pick.elements[0].line, 5);
  EXPECT_EQ(numbers_of(*pick.elements[0].numbers), (SixNumbers{1, 0, 0, 0, 0, -6.5}));
  EXPECT_EQ(pick.elements[0].posture,
            (PostureWords{ShoulderWord::kRighty, ElbowWord::kPositive, WristWord::kFree}));
  EXPECT_EQ(pick.elements[0].father->name, "fPiece");
  EXPECT_EQ(pick.elements[0].father->key, "1");
  EXPECT_EQ(pick.elements[1].posture, PostureWords{});
  EXPECT_FALSE(pick.elements[1].father);
  EXPECT_EQ(of("jHome").kind, StoredKind::kJoint);
  EXPECT_EQ(numbers_of(*of("jHome").elements[0].numbers), (SixNumbers{0, 0, 0, 0, 90, 0}));
  EXPECT_EQ(of("pGrid").elements[0].key, "1,2");
  EXPECT_EQ(of("pGrid").elements[0].father->alias, "lib");
  EXPECT_EQ(of("pGrid").elements[0].father->name, "fBase");
  EXPECT_EQ(of("pGrid").elements[0].father->key, "0");
  EXPECT_EQ(of("nCount").kind, StoredKind::kPlain);
  EXPECT_EQ(of("tGrip").kind, StoredKind::kPlain);
  EXPECT_EQ(of("pScara").kind, StoredKind::kOtherArm);
  EXPECT_EQ(of("qPart").kind, StoredKind::kUnknown);
  EXPECT_TRUE(of("pByName").is_collection);
  EXPECT_EQ(shown_element(of("pByName"), of("pByName").elements[0].key), "pByName[\"left hand\"]");
}

TEST(StoredData, RefusesWithTheLineAndTheRemedy) {
  EXPECT_EQ(data_refusal("<fish/>"),
            "cell.dtx:1: \"fish\" of \"\" is no VAL3 data of s5 to s8; give a .dtx file");
  EXPECT_THAT(data_refusal(new_data("<Data type=\"num\"/>")), HasSubstr("Data has no name; write name="));
  EXPECT_THAT(data_refusal(new_data("<Data name=\"a\"/>")), HasSubstr("Data has no type; write type="));
  EXPECT_THAT(data_refusal(new_data(variable("a", "num", "") + variable("a", "bool", ""))),
              HasSubstr("cell.dtx:6: \"a\" is there twice, first in line 4; rename one of them"));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", "", "many"))),
              HasSubstr("the size of \"p\" is \"many\"; write one to three numbers"));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", value("key=\"3\""), "3"))),
              HasSubstr("[3] is no element of \"p\", whose size is 3; an array counts from 0"));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", value("key=\"1 3\""), "2 3"))),
              HasSubstr("[1,3] is no element of \"p\""));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", value("key=\"x\"")))), HasSubstr("is no index"));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", value("x=\"1\"") + value("key=\"0\"")))),
              HasSubstr("p[0] is there twice"));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", value("fatherId=\"f]\"")))),
              HasSubstr("fatherId is \"f]\"; write name[index]"));
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", value("wrist=\"left\"")))),
              HasSubstr("wrist is \"left\"; write one of wsame, wfree, wpositive, wnegative"));
}

TEST(StoredData, RefusesMoreElementsThanAnyProgramHas) {
  std::string values;
  for (std::size_t i = 0; i <= kStoredElementsMax; ++i)
    values += "<Value key=\"" + std::to_string(i) + "\"/>";
  EXPECT_THAT(data_refusal(new_data(variable("p", "pointRx", values, "300000"))),
              HasSubstr("is the value after 200000 others"));
}

}  // namespace
}  // namespace cell
