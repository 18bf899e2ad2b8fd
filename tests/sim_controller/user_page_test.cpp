#include "sim_controller/user_page.hpp"

#include <gtest/gtest.h>

namespace sim {
namespace {

TEST(UserPage, PutGoesOnInTheNextLineAtColumn40) {
  UserPage page;
  page.put(std::string(45, 'a'), false);
  page.put("b", true);
  page.put("c", false);
  EXPECT_EQ(page.line(0), std::string(40, 'a'));
  EXPECT_EQ(page.line(1), "aaaaab");
  EXPECT_EQ(page.line(2), "c");
}

TEST(UserPage, ScrollsUpByALineAtItsEnd) {
  UserPage page;
  for (int i = 0; i < UserPage::kRows + 2; ++i) page.put(std::to_string(i), true);
  EXPECT_EQ(page.line(0), "3");
  EXPECT_EQ(page.line(UserPage::kRows - 2), "15");
  EXPECT_EQ(page.line(UserPage::kRows - 1), "");
}

TEST(UserPage, AFullLastLineScrollsWithItsNextCharacterOnly) {
  UserPage page;
  page.go_to(0, UserPage::kRows - 1);
  page.put(std::string(UserPage::kColumns, 'x'), false);
  EXPECT_EQ(page.line(UserPage::kRows - 1), std::string(UserPage::kColumns, 'x'));
  page.put("y", false);
  EXPECT_EQ(page.line(UserPage::kRows - 2), std::string(UserPage::kColumns, 'x'));
  EXPECT_EQ(page.line(UserPage::kRows - 1), "y");
}

TEST(UserPage, PlacesAreModuloItsSize) {
  UserPage page;
  page.go_to(UserPage::kColumns + 3, UserPage::kRows + 2);
  page.put("x", false);
  page.go_to(-1, -1);
  page.put("y", false);
  EXPECT_EQ(page.line(2), "   x");
  EXPECT_EQ(page.line(UserPage::kRows - 1).back(), 'y');
}

TEST(UserPage, ClearGoesHomeAndKeepsTheTitle) {
  UserPage page;
  page.set_title("cell 4");
  page.put("some text", true);
  page.clear();
  page.put("x", false);
  EXPECT_EQ(page.line(0), "x");
  EXPECT_EQ(page.title(), "cell 4");
}

TEST(UserPage, CountsCharactersAndNotBytesAndTakesAnyBytes) {
  UserPage page;
  page.put("\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80z", false);
  page.go_to(3, 0);
  page.put("y", false);
  EXPECT_EQ(page.line(0), "\xC3\xA9\xE2\x82\xAC\xF0\x9F\x98\x80y");
  page.go_to(0, 1);
  page.put("a\xC3", false);
  page.put("\xFF\x80\x01", false);
  EXPECT_EQ(page.line(1), "a???");
}

TEST(UserPage, AKeyIsTakenOnceAndOnlyWhileThePageIsShown) {
  UserPage page;
  page.press(270);
  EXPECT_EQ(page.take_key(), std::nullopt);
  page.show();
  page.press(271);
  page.press(272);
  EXPECT_TRUE(page.is_pressed(271));
  EXPECT_EQ(page.take_key(), 272);
  EXPECT_EQ(page.take_key(), std::nullopt);
  page.release(271);
  EXPECT_FALSE(page.is_pressed(271));
}

TEST(UserPage, ElementsOfAPageOfHtmlKeepTheirLastTextUpToALimit) {
  UserPage page;
  page.set_element("ux.lbl.innerHTML", "1");
  page.set_element("ux.lbl.innerHTML", "2");
  EXPECT_EQ(page.elements().at("ux.lbl.innerHTML"), "2");
  for (std::size_t i = 0; i < 2 * UserPage::kElementsMax; ++i) page.set_element(std::to_string(i), "x");
  page.set_element("ux.lbl.innerHTML", "3");
  EXPECT_EQ(page.elements().size(), UserPage::kElementsMax);
  EXPECT_EQ(page.elements().at("ux.lbl.innerHTML"), "3") << "one that is there still changes";
}

}  // namespace
}  // namespace sim
