#include "service/offline_programs/xml_text.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal_of(const std::string& bytes) {
  return error_of([&] { const XmlText xml("cell.dtx", bytes); }).what();
}

TEST(XmlText, KnowsWhereEachAttributeStandsInTheFile) {
  const std::string bytes =
      "\xEF\xBB\xBF<?xml version='1.0'?>\r\n<!-- <a x=\"1\"/> -->\r\n<a one = 'x &amp; y'\r\n two=\"\"><b "
      "three=\"3\"/></a>\r\n";
  const XmlText xml("cell.dtx", bytes);
  const auto text_of = [&](pugi::xml_attribute attribute) {
    const auto [begin, end] = xml.value_span(attribute);
    return bytes.substr(begin, end - begin);
  };
  EXPECT_EQ(xml.bytes(), bytes);
  EXPECT_EQ(text_of(xml.root().attribute("one")), "x &amp; y");
  EXPECT_STREQ(xml.root().attribute("one").value(), "x & y");
  EXPECT_EQ(text_of(xml.root().attribute("two")), "");
  const pugi::xml_node inner = element_named(xml.root(), "b");
  EXPECT_EQ(text_of(inner.attribute("three")), "3");
  EXPECT_EQ(xml.place_of(inner.name()), bytes.find("b three"));
  EXPECT_EQ(xml.line_of(xml.root()), 3);
  EXPECT_EQ(xml.line_of(inner), 4);
}

TEST(XmlText, ReadsBytesOfLatin1AsTheyAre) {
  const std::string bytes = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<a name=\"caf\xE9\" x=\"1\"/>";
  const XmlText xml("old.dtx", bytes);
  EXPECT_STREQ(xml.root().attribute("name").value(), "caf\xE9");
  EXPECT_EQ(xml.value_span(xml.root().attribute("x")).begin, bytes.find("1\"/>"));
}

TEST(XmlText, TellsNamespaceAndTypeWithPrefixes) {
  const XmlText xml("x", "<v:Data xmlns:v=\"space\" xsi:type=\"array\" type=\"num\"/>");
  EXPECT_EQ(xml.root_space(), "space");
  EXPECT_EQ(unprefixed(xml.root().name()), "Data");
  EXPECT_EQ(xsi_type_of(xml.root()), "array");
}

TEST(XmlText, RefusesWhatIsNoWholeXmlWithItsLine) {
  EXPECT_THAT(refusal_of("<a>\n<b>\n</a>"), StartsWith("cell.dtx:3: is no whole XML"));
  EXPECT_THAT(refusal_of("<a>\n<b x=\"1\"/>\n"), HasSubstr("is no whole XML"));
  EXPECT_THAT(refusal_of("<a>\n<b x=\"1"), EndsWith("save it again from its editor"));
  EXPECT_THAT(refusal_of("no XML at all"), HasSubstr("is no whole XML"));
  EXPECT_THAT(refusal_of("<a/><b/>"), HasSubstr("more than one outermost element"));
  EXPECT_THAT(refusal_of(std::string("<a/>\0", 5)), HasSubstr("save it as UTF-8"));
  EXPECT_THAT(refusal_of("<?xml version=\"1.0\" encoding=\"UTF-16\"?><a/>"),
              HasSubstr("is in the encoding \"utf-16\"; save it as UTF-8"));
}

// Half a file, cut anywhere: none of its halves is taken for a whole one.
TEST(XmlText, RefusesAFileThatIsCutAnywhere) {
  const std::string whole = "<?xml version=\"1.0\"?>\n<a><!-- c --><b x=\"1\" y='2'><![CDATA[t]]></b></a>";
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(XmlText("cut.dtx", whole.substr(0, size)), ConfigError) << size;
  EXPECT_NO_THROW(XmlText("whole.dtx", whole));
}

TEST(XmlText, RefusesAHundredMegabytesBySize) {
  EXPECT_THAT(refusal_of(std::string(100'000'000, 'x')),
              HasSubstr("has 100000000 bytes, more than the 16777216 that are read; divide it"));
}

TEST(XmlText, IsNotToppledByElementsThatNest) {
  std::string bytes;
  for (int i = 0; i < 200'000; ++i) bytes += "<a>";
  for (int i = 0; i < 200'000; ++i) bytes += "</a>";
  const XmlText xml("deep.dtx", bytes);
  EXPECT_EQ(unprefixed(xml.root().name()), "a");
}

}  // namespace
}  // namespace cell
