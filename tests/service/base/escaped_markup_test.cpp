#include "service/base/escaped_markup.hpp"

#include <gtest/gtest.h>

namespace cell {
namespace {

TEST(EscapedMarkup, LeavesNothingThatAReaderOfMarkupWouldTakeForIt) {
  EXPECT_EQ(escaped_markup("<a href=\"x\">'&\x01\n\t"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;\n\t");
  EXPECT_EQ(escaped_markup("Jürgen"), "Jürgen");
}

}  // namespace
}  // namespace cell
