#include "service/setup/block_text.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace cell {
namespace {

using nlohmann::json;

TEST(BlockText, CallsThePlanesAsOperatorsDo) {
  const json document = json::parse(block_text({}, {-625.0, -120.0, 0.0}));
  EXPECT_EQ(document["certificate"]["planes"], "1 right, 2 near, 3 top, 4 left, 5 ground plate");
}

TEST(BlockText, HasTheCertificateOnEachFaceAndLength) {
  CuboidAnswers block;
  block.std_mm = 0.002;
  block.serial = "B-7";
  block.certificate = {{"number", "K 12"}, {"valid_until", "2027-01-31"}};
  const json document = json::parse(block_text(block, {-625.0, -120.0, 0.0}));
  EXPECT_EQ(document["serial"], "B-7");
  EXPECT_EQ(document["certificate"]["valid_until"], "2027-01-31");
  for (const json& face : document["faces"]) EXPECT_EQ(face["std_offset_mm"], 0.002);
  ASSERT_EQ(document["lengths"].size(), 2U);
  EXPECT_EQ(document["lengths"][0]["planes"], json({1, 4}));
  EXPECT_EQ(document["lengths"][1]["planes"], json({3, 5})) << "the height, by top and plate";
  EXPECT_EQ(document["lengths"][1]["std_mm"], 0.002);
}

TEST(BlockText, SaysNothingOfATemperatureThatIsNotKnown) {
  CuboidAnswers block;
  block.temperature_c = std::nullopt;
  const json document = json::parse(block_text(block, {-625.0, -120.0, 0.0}));
  EXPECT_FALSE(document.contains("temperature_c"));
  EXPECT_FALSE(document.contains("std_temperature_k"));
  EXPECT_TRUE(document.contains("thermal_expansion_per_k")) << "each run brings a temperature";
}

}  // namespace
}  // namespace cell
