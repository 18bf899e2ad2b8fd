#include "service/offline_programs/number_places.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The element with these numbers written into it, and the names of what was inserted.
std::pair<std::string, std::vector<std::string>> written(const std::string& element,
                                                         const SixNumbers& numbers) {
  const XmlText xml("cell.dtx", element);
  const NumberPlaces places = number_places(xml, xml.root(), kTrsfNames);
  std::vector<TextEdit> edits;
  auto inserted = append_edits(xml, places, kTrsfNames, numbers, edits);
  return {edited(xml.bytes(), edits), inserted};
}

TEST(StoredNumber, HasAtMostSixDecimalsAndNoMinusBeforeZero) {
  EXPECT_EQ(stored_number(12.0), "12");
  EXPECT_EQ(stored_number(-0.5), "-0.5");
  EXPECT_EQ(stored_number(1.0000004), "1");
  EXPECT_EQ(stored_number(123.4567891), "123.456789");
  EXPECT_EQ(stored_number(-0.0000001), "0");
  EXPECT_EQ(stored_number(100.0), "100");
  EXPECT_THROW(stored_number(std::numeric_limits<double>::quiet_NaN()), std::logic_error);
}

TEST(NumberPlaces, ReplaceNumbersAndNothingAroundThem) {
  EXPECT_EQ(written("<Value  key='0'\n x = ' 1.50 ' z=\"2\" other=\"3\" />", {1, 0, 2, 0, 0, 0}).first,
            "<Value  key='0'\n x = ' 1 ' z=\"2\" other=\"3\" />");
}

TEST(NumberPlaces, KeepTheWritingOfWhatIsTheSameInSixDecimals) {
  const std::string element = "<Value x=\"1.500\" y=\"+2\" z=\"0.12345678901\" rx=\"-0\"/>";
  const auto [text, inserted] = written(element, {1.5, 2, 0.1235, 0, 0, 0});
  EXPECT_EQ(text, element.substr(0, 23) + " z=\"0.1235\" rx=\"-0\"/>");
  EXPECT_THAT(inserted, IsEmpty());
  EXPECT_EQ(written(element, {1.5, 2, 0.12345678901, 0, 0, 0}).first, element);
}

TEST(NumberPlaces, InsertWhatWasLeftOutBehindTheOneBeforeIt) {
  const auto [text, inserted] =
      written("<Value key=\"0\" y='2' rz='3' fatherId=\"world[0]\"/>", {1, 2, 4, 0, 5, 3});
  EXPECT_EQ(text, "<Value key=\"0\" x=\"1\" y='2' z='4' ry='5' rz='3' fatherId=\"world[0]\"/>");
  EXPECT_THAT(inserted, ElementsAre("x", "z", "ry"));
  EXPECT_EQ(written("<Value/>", {1, 2, 0, 0, 0, 0}).first, "<Value x=\"1\" y=\"2\"/>");
  EXPECT_EQ(written("<Value fatherId=\"w[0]\" key=\"0\"/>", {0, 2, 0, 0, 0, 0}).first,
            "<Value fatherId=\"w[0]\" key=\"0\" y=\"2\"/>");
}

TEST(NumberPlaces, RefuseWhatIsNoNumberOfAnArm) {
  const auto refusal = [](const std::string& element) {
    return std::string(error_of([&] {
                         const XmlText xml("cell.dtx", element);
                         number_places(xml, xml.root(), kTrsfNames);
                       }).what());
  };
  EXPECT_EQ(refusal("<Value\n x=\"one\"/>"), "cell.dtx:1: x is \"one\"; write a number");
  EXPECT_THAT(refusal("<Value x=\"\"/>"), HasSubstr("write a number"));
  EXPECT_THAT(refusal("<Value x=\"nan\"/>"), HasSubstr("write a number"));
  EXPECT_THAT(refusal("<Value x=\"1,5\"/>"), HasSubstr("write a number"));
  EXPECT_THAT(refusal("<Value x=\"&#49;\"/>"), HasSubstr("write a number"));
  EXPECT_THAT(refusal("<Value z=\"-100001\"/>"), HasSubstr("no place of an arm's is beyond 100000"));
  EXPECT_THAT(refusal("<Value x=\"1\" y=\"1\" x=\"2\"/>"), HasSubstr("x is there twice"));
}

TEST(Edited, RefusesEditsThatOverlap) {
  EXPECT_EQ(edited("abcdef", {{4, 5, "E"}, {1, 1, "x"}, {1, 1, "y"}, {1, 2, ""}}), "axycdEf");
  EXPECT_THROW(edited("abcdef", {{1, 3, "x"}, {2, 4, "y"}}), std::logic_error);
  EXPECT_THROW(edited("abcdef", {{5, 7, "x"}}), std::logic_error);
}

}  // namespace
}  // namespace cell
