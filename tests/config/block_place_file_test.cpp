#include "config/block_place_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/config_error.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

json known_place() {
  return {{"name", "stand"},  {"position_mm", {0, -300, 0}}, {"rotation_deg", {0, 0, 90}},
          {"place", "known"}, {"std_position_mm", 0.01},     {"std_rotation_rad", 3e-5}};
}

BlockPlace read_place(const json& document) {
  return block_place_from_json(JsonValue("block.json", document));
}

/// "" where it is read.
std::string refusal_with(const char* key, const json& value) {
  json document = known_place();
  document[key] = value;
  try {
    static_cast<void>(read_place(document));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(BlockPlaceFile, ReadsAKnownPlace) {
  const BlockPlace place = read_place(known_place());
  EXPECT_EQ(place.name, "stand");
  EXPECT_DOUBLE_EQ(place.first_from_place.translation().y(), -0.3);
  EXPECT_NEAR(place.first_from_place.linear()(1, 0), 1.0, 1e-15);
  EXPECT_DOUBLE_EQ(place.std.value().std_position_m, 1e-5);
  EXPECT_DOUBLE_EQ(place.std.value().std_turn_rad, 3e-5);
  EXPECT_FALSE(place.thermal_expansion_per_k) << "that of the block";
}

TEST(BlockPlaceFile, ReadsAPlaceThatTheTouchesFind) {
  const BlockPlace place = read_place({{"name", "shelf"},
                                       {"position_mm", {300, 0, 0}},
                                       {"rotation_deg", {0, 0, 0}},
                                       {"place", "estimated"},
                                       {"within_mm", 3},
                                       {"thermal_expansion_per_k", 1.2e-5}});
  EXPECT_FALSE(place.std);
  EXPECT_DOUBLE_EQ(place.within_m, 0.003);
  EXPECT_DOUBLE_EQ(place.thermal_expansion_per_k.value(), 1.2e-5);
}

TEST(BlockPlaceFile, RefusesWhatNobodyCouldMean) {
  EXPECT_THAT(refusal_with("name", "first"), HasSubstr("is the place where the block is located"));
  EXPECT_THAT(refusal_with("name", "the stand"), HasSubstr("of the characters a to z"));
  EXPECT_THAT(refusal_with("name", ""), HasSubstr("/name: is empty"));
  EXPECT_THAT(refusal_with("name", "on"), HasSubstr("means something else"));
  EXPECT_THAT(refusal_with("name", "stand_turn"), HasSubstr("means something else"));
  EXPECT_THAT(refusal_with("place", "guessed"), HasSubstr(R"(give "known" or "estimated")"));
  EXPECT_THAT(refusal_with("place", "estimated"), HasSubstr("found by the touches"));
  EXPECT_THAT(refusal_with("within_mm", 3), HasSubstr("stands at a place that is known"));
  EXPECT_THAT(refusal_with("std_position_mm", 0), HasSubstr("/std_position_mm"));
  EXPECT_THAT(refusal_with("std_rotation_rad", 0.5), HasSubstr("/std_rotation_rad"));
  EXPECT_THAT(refusal_with("color", "red"), HasSubstr("color"));
}

}  // namespace
}  // namespace cell
