#include "config/target_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/json_value.hpp"
#include "tests/config/copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const json kPallet = {{"position_mm", {400, 100, 0}}, {"rotation_deg", {0, 0, 90}}, {"touched", "no"}};

class CellWithFrames : public CopiedConfig {
 protected:
  Cell read_with(const json& frames) {
    edit(kCell, [&](json& cell) {
      cell["schema"] = kCellSchema;
      cell["target_frames"] = frames;
    });
    return read();
  }
  std::string refusal_of(const json& frames) {
    return error_of([&] { read_with(frames); }).what();
  }
};

TEST_F(CellWithFrames, HasEachAtItsPoseInTheControllersWorld) {
  EXPECT_TRUE(read().target_frames.empty());
  json by_the_arm = kPallet;
  by_the_arm["touched"] = "nominal";
  const TargetFrames frames = read_with({{"pallet", kPallet}, {"the fixture", by_the_arm}}).target_frames;
  ASSERT_EQ(frames.size(), 2U);
  const Eigen::Isometry3d pallet = world_from_target_frame(frames, "pallet");
  EXPECT_TRUE((pallet * Eigen::Vector3d(0.01, 0, 0)).isApprox(Eigen::Vector3d(0.4, 0.11, 0)));
  EXPECT_TRUE(world_from_target_frame(frames, "world").isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_EQ(why_no_target_frame(frames, "pallet"), "");
  EXPECT_EQ(why_no_target_frame(frames, "world"), "");
}

TEST_F(CellWithFrames, RefusesAFrameThatThereIsNotAndOneThatHoldsTheArmsErrors) {
  json by_the_arm = kPallet;
  by_the_arm["touched"] = "nominal";
  const TargetFrames frames = read_with({{"pallet", kPallet}, {"fixture", by_the_arm}}).target_frames;
  EXPECT_EQ(
      why_no_target_frame(frames, "palet"),
      "is \"palet\", which the cell does not have; give one of world, fixture, pallet, or add it to the "
      "\"target_frames\" of the cell's file");
  EXPECT_THAT(why_no_target_frame(frames, "fixture"),
              HasSubstr("is \"fixture\", which was touched with the nominal arm"));
}

TEST_F(CellWithFrames, NamesThePlaceOfWhatIsWrong) {
  const auto with = [](const std::string& key, const json& value) {
    json frame = kPallet;
    frame[key] = value;
    return json{{"pallet", frame}};
  };
  EXPECT_THAT(refusal_of(with("touched", "yes")),
              HasSubstr("/target_frames/pallet/touched: is \"yes\"; give \"no\""));
  EXPECT_THAT(refusal_of(with("position_mm", {1, 2})),
              HasSubstr("/target_frames/pallet/position_mm: wants 3"));
  EXPECT_THAT(refusal_of(with("position_mm", {1, 2, 1e9})), HasSubstr("/position_mm/2: is 1000000000"));
  EXPECT_THAT(refusal_of(with("std_mm", 1)), HasSubstr("unknown key \"std_mm\""));
  json unsaid = kPallet;
  unsaid.erase("touched");
  EXPECT_THAT(refusal_of({{"pallet", unsaid}}), HasSubstr("\"touched\" is missing"));
  EXPECT_THAT(refusal_of({{"world", kPallet}}), HasSubstr("/target_frames/world: is the controller's own"));
  EXPECT_THAT(refusal_of({{std::string(65, 'p'), kPallet}}), HasSubstr("has a name of 65 bytes"));
  json many = json::object();
  for (std::size_t i = 0; i <= kTargetFrameCountMax; ++i) many["f" + std::to_string(i)] = kPallet;
  EXPECT_THAT(refusal_of(many), HasSubstr("/target_frames: has 1001 frames; give at most 1000"));
  edit(kCell, [](json& cell) {
    cell["schema"] = kSixthCellSchema;
    cell["target_frames"] = {{"pallet", kPallet}};
  });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/target_frames");
}

TEST_F(CellWithFrames, OfACalibratedArmIsThatOfItsRobot) {
  edit(kArm, [](json& arm) {
    arm["schema"] = kArmSchema;
    arm["serial"] = "ONE";
  });
  edit(kCell, [](json& cell) { cell.erase("arm_serial"); });
  EXPECT_EQ(read().arm.serial, "ONE");
  edit(kCell, [](json& cell) { cell["arm_serial"] = "ONE"; });
  EXPECT_NO_THROW(static_cast<void>(read()));
  edit(kCell, [](json& cell) { cell["arm_serial"] = "TWO"; });
  EXPECT_THAT(
      std::string(error_of([&] { static_cast<void>(read()); }).what()),
      HasSubstr("/arm: is the arm of the robot with the serial number \"ONE\", and /arm_serial is \"TWO\""));
}

}  // namespace
}  // namespace cell
