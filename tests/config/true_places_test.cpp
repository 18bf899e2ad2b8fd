#include "config/true_places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/touched_places.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The demo cell whose block can stand 300 mm higher; y of R_-1 points down.
class TruePlaces : public CopiedConfig {
 protected:
  TruePlaces() {
    edit(kBlock, [](json& document) {
      document["schema"] = "touchcal/block/4";
      document["places"] = {{{"name", "stand"},
                             {"position_mm", {10, -300, 0}},
                             {"rotation_deg", {0, 90, 0}},
                             {"place", "known"},
                             {"std_position_mm", 0.01},
                             {"std_rotation_rad", 3e-5}}};
    });
  }
  [[nodiscard]] Truth truth_with(const json& places) const {
    edit(kRealTruth, [&](json& document) {
      document["schema"] = "touchcal/truth/3";
      document["places"] = places;
    });
    return read_truth(path(kRealTruth));
  }
  [[nodiscard]] Eigen::Isometry3d stand_of(const Truth& truth, const Block& block) const {
    const auto poses = true_places(truth, block);
    EXPECT_EQ(poses.size(), 1U);
    return poses.front();
  }
  [[nodiscard]] ConfigError error_with(const json& places) const {
    return error_of([&] { static_cast<void>(truth_with(places)); });
  }
};

TEST_F(TruePlaces, AreThoseOfTheFileWhereTheTruthSaysNothing) {
  Block block = read().block;
  block.temperature_c = 20.0;
  const Eigen::Isometry3d pose = stand_of({}, block);
  EXPECT_TRUE(pose.isApprox(block.places[0].first_from_place, 0.0));
}

TEST_F(TruePlaces, AreShiftedAndTurnedAboutTheirOwnOriginAlongTheAxesOfTheFirstPlace) {
  const Truth truth =
      truth_with({{"stand", {{"shift_mm", {0.004, -0.002, 1}}, {"turn_rad", {0, 0, 0.003}}}}});
  ASSERT_EQ(truth.places.size(), 1U);
  Truth cool = truth;
  cool.warming.block_warmer_k = 0.0;
  const Block block = read().block;
  const Eigen::Isometry3d& file = block.places[0].first_from_place;
  const Eigen::Isometry3d pose = stand_of(cool, block);
  EXPECT_TRUE((pose.translation() - file.translation()).isApprox(Eigen::Vector3d(4e-6, -2e-6, 1e-3), 1e-9));
  const Eigen::Matrix3d turn = pose.linear() * file.linear().transpose();
  EXPECT_TRUE(turn.isApprox(Eigen::AngleAxisd(0.003, Eigen::Vector3d::UnitZ()).toRotationMatrix(), 1e-12));
}

TEST_F(TruePlaces, AreAsFarApartAsTheirWarmthMakesThem) {
  Block block = read().block;
  block.temperature_c = 23.0;
  Truth truth;
  truth.warming.block_warmer_k = 2.0;
  const double step_m = block.places[0].first_from_place.translation().y();
  EXPECT_NEAR(stand_of(truth, block).translation().y(), step_m * (1.0 + 5.0 * 2.36e-5), 1e-12);
  block.places[0].thermal_expansion_per_k = 1.1e-5;  // it stands on steel
  EXPECT_NEAR(stand_of(truth, block).translation().y(), step_m * (1.0 + 5.0 * 1.1e-5), 1e-12);
  truth.warming.block_warmer_k = 0.0;
  Recipe recipe;
  recipe.places = {0};
  EXPECT_TRUE(stand_of(truth, block).isApprox(artefact_places(block, recipe)[1].pose, 1e-15))
      << "a block that is as warm as its file says stands where the daemon has it";
}

TEST_F(TruePlaces, CanBeSwitchedOffWithTheirValuesKept) {
  const json stand{{"shift_mm", {1, 0, 0}}};
  EXPECT_EQ(truth_with({{"stand", stand}, {"on", true}}).places.size(), 1U);
  EXPECT_TRUE(truth_with({{"stand", stand}, {"on", false}}).places.empty());
  EXPECT_EQ(error_with({{"stand", {{"shift_mm", {51, 0, 0}}}}, {"on", false}}).pointer(),
            "/places/stand/shift_mm");
}

TEST_F(TruePlaces, ThatAreFarOffOrOfNoBlockOrOfAnOlderFileAreRefused) {
  EXPECT_EQ(error_with({{"stand", {{"turn_rad", {0, 0.051, 0}}}}}).pointer(), "/places/stand/turn_rad");
  EXPECT_THAT(error_with({{"stand", {{"shift_mm", {0, 40, 40}}}}}).message(), HasSubstr("over 50 mm"));
  EXPECT_EQ(error_with({{"stand", {{"shift", {0, 0, 0}}}}}).pointer(), "/places/stand/shift");
  EXPECT_EQ(error_with({{"on", 1}}).pointer(), "/places/on");

  const Truth elsewhere = truth_with({{"shelf", {{"shift_mm", {1, 0, 0}}}}});
  const ConfigError unknown = error_of([&] { static_cast<void>(true_places(elsewhere, read().block)); });
  EXPECT_EQ(unknown.pointer(), "/places/shelf");
  EXPECT_THAT(unknown.message(), HasSubstr("give one of \"stand\""));
  edit(kBlock, [](json& document) { document.erase("places"); });
  EXPECT_THAT(error_of([&] { static_cast<void>(true_places(elsewhere, read().block)); }).message(),
              HasSubstr("leave \"places\" out"));

  edit(kRealTruth, [](json& document) { document["schema"] = "touchcal/truth/2"; });
  const ConfigError old = error_of([&] { static_cast<void>(read_truth(path(kRealTruth))); });
  EXPECT_EQ(old.pointer(), "/places");
  EXPECT_THAT(old.message(), HasSubstr("raise \"schema\" to 3"));
}

}  // namespace
}  // namespace cell
