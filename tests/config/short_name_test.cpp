#include "config/short_name.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/config_error.hpp"

namespace cell {
namespace {

using testing::HasSubstr;

std::string read_name(const nlohmann::json& name) { return short_name(JsonValue("probe.json", name)); }

/// "" where it is read.
std::string refusal_of_name(const nlohmann::json& name) {
  try {
    static_cast<void>(read_name(name));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ShortName, IsMadeOfWhatAParametersNameCanHave) {
  for (const char* name : {"left", "x", "tip_2", "first", "turned"}) EXPECT_EQ(read_name(name), name);
  EXPECT_EQ(read_name(std::string(32, 'a')).size(), 32U);
}

TEST(ShortName, IsNothingElse) {
  const std::string long_name(33, 'a');
  for (const char* name : {"Left", "the tip", "a-b", "f\303\266rste", long_name.c_str()})
    EXPECT_THAT(refusal_of_name(name), HasSubstr("give 1 to 32 of the characters a to z")) << name;
  EXPECT_THAT(refusal_of_name(""), HasSubstr("is empty"));
  EXPECT_THAT(refusal_of_name(1), HasSubstr("is a number"));
  for (const char* name : {"on", "left_turn"})
    EXPECT_THAT(refusal_of_name(name), HasSubstr("means something else")) << name;
}

}  // namespace
}  // namespace cell
