#include "service/base/json_figures.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace cell {
namespace {

TEST(JsonFigures, AnAbsentOrNonFiniteFigureIsNull) {
  EXPECT_TRUE(number(std::nullopt).is_null());
  EXPECT_TRUE(number(std::numeric_limits<double>::quiet_NaN()).is_null());
  EXPECT_TRUE(number_mm(std::numeric_limits<double>::infinity()).is_null());
  EXPECT_EQ(number_mm(0.25), 250.0);
}

TEST(JsonFigures, AnAbsentValueIsNullAndAnotherIsItself) {
  EXPECT_TRUE(value_or_null(std::optional<bool>()).is_null());
  EXPECT_EQ(value_or_null(std::optional(false)), false);
  EXPECT_EQ(value_or_null(std::optional(7)), 7);
  EXPECT_EQ(value_or_null(std::optional<std::string>("text")), "text");
}

TEST(JsonFigures, BytesThatAreNotUtf8AreReplaced) { EXPECT_EQ(text_of("\xff"), "\"\xef\xbf\xbd\""); }

}  // namespace
}  // namespace cell
