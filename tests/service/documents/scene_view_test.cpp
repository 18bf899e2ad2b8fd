#include "service/documents/scene_view.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace cell {
namespace {

using nlohmann::json;

TEST(SceneView, JointsAreUnknownUntilTheControllerToldThem) {
  const json unknown = json::parse(joints_document(std::nullopt, {.instance_id = "i"}));
  EXPECT_TRUE(unknown.at("joints_deg").is_null());
  EXPECT_TRUE(unknown.at("data_age_ms").is_null());
  cs8::State told;
  told.joints = {1'500'000, -2'000'000, 0, 4, 5, 6};
  const json known =
      json::parse(joints_document(told, {.sequence = 7, .instance_id = "i", .data_age_ms = 12}));
  EXPECT_EQ(known.at("joints_deg"), json::parse("[1.5,-2.0,0.0,4e-6,5e-6,6e-6]"));
  EXPECT_EQ(known.at("data_age_ms"), 12);
  EXPECT_EQ(known.at("sequence"), 7);
}

}  // namespace
}  // namespace cell
