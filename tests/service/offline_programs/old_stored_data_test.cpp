// Data files of s5 and s6.
#include <gmock/gmock.h>

#include "service/offline_programs/stored_data.hpp"
#include "tests/config/folder.hpp"
#include "tests/service/offline_programs/val3_texts.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

constexpr const char* kPointOfTable =
    "<pointSection><point name=\"p\" public=\"false\"><pFather alias=\"\" name=\"fTable\" fatherIndex=\"1\"/>"
    "<valuePoint index=\"1\"><tpValue x=\"1\" y=\"2\" z=\"3\" rx=\"4\" ry=\"5\" rz=\"6\"/>"
    "<cpValue shoulder=\"lefty\" elbow=\"same\" wrist=\"negative\"/></valuePoint>"
    "<valuePoint index=\"0\"><tpValue x=\"7\" y=\"0\" z=\"0\" rx=\"0\" ry=\"0\" rz=\"0\"/>"
    "</valuePoint></point></pointSection>\r\n";

std::string old_refusal(const std::string& sections) {
  return error_of([&] {
           const XmlText xml("old.dtx", old_data(sections));
           read_stored_data(xml);
         })
      .what();
}

TEST(OldStoredData, KnowsWhatTheNewOneKnows) {
  const XmlText xml("old.dtx", old_data(std::string(kPointOfTable) +
                                        "<jointSection><joint name=\"j\"><valueJoint index=\"0\"><jointValue "
                                        "j1=\"1\" j2=\"2\" j3=\"3\" j4=\"4\" j5=\"5\" j6=\"6\"/></valueJoint>"
                                        "</joint></jointSection><pointRsSection><pointRs name=\"s\"/>"
                                        "</pointRsSection><numSection><num name=\"n\"/></numSection>"
                                        "<jointVrbSection/>"));
  const StoredData data = read_stored_data(xml);
  ASSERT_EQ(data.variables.size(), 4U);
  const StoredVariable& point = data.variables[0];
  EXPECT_EQ(point.kind, StoredKind::kPoint);
  ASSERT_EQ(point.elements.size(), 2U);
  EXPECT_EQ(point.elements[0].key, "1");
  EXPECT_EQ(point.elements[0].father->name, "fTable");
  EXPECT_EQ(point.elements[1].father->key, "1") << "one father for all values";
  EXPECT_EQ(numbers_of(*point.elements[0].numbers), (SixNumbers{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(point.elements[0].posture,
            (PostureWords{ShoulderWord::kLefty, ElbowWord::kSame, WristWord::kNegative}));
  EXPECT_EQ(numbers_of(*data.variables[1].elements[0].numbers), (SixNumbers{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(data.variables[2].kind, StoredKind::kOtherArm);
  EXPECT_EQ(data.variables[3].kind, StoredKind::kPlain);
}

TEST(OldStoredData, RefusesWithTheLineAndTheRemedy) {
  EXPECT_EQ(old_refusal("<fishSection/>"),
            "old.dtx:3: \"fishSection\" is no section of data; remove it, or save the file as s7");
  EXPECT_THAT(old_refusal("<pointSection><point name=\"p\"><fish/></point></pointSection>"),
              HasSubstr("\"fish\" does not belong into a point; remove it"));
  EXPECT_THAT(
      old_refusal("<trsfSection><trsf name=\"t\"><valueTrsf index=\"0\"/><valueTrsf index=\"0\"/></trsf>"
                  "</trsfSection>"),
      HasSubstr("t[0] is there twice"));
  EXPECT_THAT(old_refusal("<pointSection><point public=\"true\"/></pointSection>"),
              HasSubstr("point has no name"));
}

TEST(OldStoredData, IsFilteredInTheElementOfItsNumbers) {
  const std::string original = old_data(
      "<frameSection><frame name=\"fTable\"><fFather alias=\"\" name=\"\" fatherIndex=\"0\"/>"
      "<valueFrame index=\"1\"><tfValue x=\"10\" y=\"0\" z=\"0\" rx=\"0\" ry=\"0\" rz=\"90\"/>"
      "</valueFrame></frame></frameSection>\r\n" +
      std::string(kPointOfTable));
  // A step along the world's x is one against the table's y.
  const FilteredData found = filtered(original, "p offline", shifted_by({0.5, 0, 0}));
  std::string wanted = original;
  const auto replace = [&](const std::string& from, const std::string& to) {
    wanted.replace(wanted.find(from), from.size(), to);
  };
  replace("x=\"1\" y=\"2\"", "x=\"1\" y=\"1.5\"");
  replace("x=\"7\" y=\"0\"", "x=\"7\" y=\"-0.5\"");
  EXPECT_EQ(found.text, wanted);
  ASSERT_EQ(found.values.size(), 2U);
  EXPECT_EQ(found.values[0].name, "p[1]");
}

TEST(OldStoredData, IsRefusedWhereAPointHasNoElementForItsNumbers) {
  const std::string data = old_data(
      "<pointSection><point name=\"p\"><pFather alias=\"\" name=\"world\" fatherIndex=\"0\"/><valuePoint "
      "index=\"0\"/></point></pointSection>");
  EXPECT_THAT(std::string(error_of([&] { filtered(data, "p offline", unchanged()); }).what()),
              HasSubstr("p[0] has no element with its numbers; write it, or mark p leave"));
  EXPECT_EQ(filtered(data, "p leave", unchanged()).text, data);
}

}  // namespace
}  // namespace cell
