#include "config/decimal_text.hpp"

#include <gmock/gmock.h>

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(DecimalText, IsWhatPeopleWrite) {
  for (const char* text : {"0", "7", "-3", "10", "18446744073709551615"})
    EXPECT_THAT(refuse_integer(text), IsEmpty()) << text;
  for (const char* text : {"0", "-3", "0.5", ".5", "-1e-3", "2.5E+02", "1e999"})
    EXPECT_THAT(refuse_number(text), IsEmpty()) << text;
}

TEST(DecimalText, IsNothingElse) {
  for (const char* text :
       {"", "-", "0x10", "0b11", "1'000", "1_000", "1.0", "1e3", " 1", "1 ", "+1", "010", "-08", "00", "ten"})
    EXPECT_THAT(refuse_integer(text), HasSubstr("'" + std::string(text) + "'")) << text;
  for (const char* text :
       {"", "-", ".", "0x1p3", "0x10", "inf", "-inf", "nan", "NAN", "1,5", "1 ", " 1", "e5"})
    EXPECT_THAT(refuse_number(text), HasSubstr("'" + std::string(text) + "'")) << text;
}

TEST(DecimalText, ACountOf64BitsIsNotCutToThem) {
  for (const char* text : {"0", "7", "18446744073709551615"})
    EXPECT_THAT(refuse_count64(text), IsEmpty()) << text;
  for (const char* text :
       {"", "-1", "-0", "0x10", "010", "1.0", "18446744073709551616", "99999999999999999999999"})
    EXPECT_THAT(refuse_count64(text), HasSubstr("'" + std::string(text) + "'")) << text;
}

}  // namespace
}  // namespace cell
