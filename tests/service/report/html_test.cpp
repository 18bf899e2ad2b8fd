#include "service/report/internal/html.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(Html, TextBecomesNoMarkup) {
  EXPECT_EQ(html::escaped("<a href=\"x\">'&\x01"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
}

TEST(Html, ATableWithoutRowsIsALineThatSaysSo) {
  EXPECT_EQ(html::table(english(), "Faults", {"code"}, {}), "<p>Faults: there are none.</p>\n");
}

}  // namespace
}  // namespace cell
