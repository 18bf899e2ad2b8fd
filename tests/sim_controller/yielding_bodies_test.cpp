#include "sim_controller/yielding_bodies.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "aimed_touch.hpp"

namespace sim::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

std::vector<std::string> yielding_names(const Plant& plant) {
  std::vector<std::string> names;
  for (const int index : yielding_bodies(plant))
    names.push_back(plant.scene.bodies.at(static_cast<std::size_t>(index)).name);
  return names;
}

calib::Capsule of_probe(const char* name, const Eigen::Vector3d& from_mm, const Eigen::Vector3d& to_mm) {
  return {name, calib::kFrameCount - 1, 1e-3 * from_mm, 1e-3 * to_mm, 1e-3};
}

TEST(YieldingBodies, OfAProbeWithOneTipAreItsStylus) {
  EXPECT_THAT(yielding_names(perfect_plant("demo")), ElementsAre("stem"));
}

TEST(YieldingBodies, OfAStarAreItsStemsAndNotWhatTheyAreFixedTo) {
  const Plant star = perfect_plant("star");
  EXPECT_THAT(yielding_names(star),
              UnorderedElementsAre("stem", "left stem", "right stem", "front stem", "back stem"));
  for (const calib::Capsule& body : star.scene.bodies)
    EXPECT_FALSE(body.frame == calib::kFrameCount - 1 && body.from_m == body.to_m)
        << body.name << ": balls touch, they do not collide";
}

TEST(YieldingBodies, OfAStarWhoseStylusIsInPiecesAreAllFromTheFirstStemOn) {
  Plant plant;
  plant.scene.bodies = {
      of_probe("body", {0, 0, -90}, {0, 0, -50}), of_probe("extension", {0, 0, -50}, {0, 0, -26}),
      of_probe("hub", {0, 0, -24}, {0, 0, -22}), of_probe("side", {0, 0, -24}, {30, 0, -24}),
      of_probe("stem", {0, 0, -22}, {0, 0, -4})};
  plant.tips = {{.center_m = {0.033, 0.0, -0.024}, .trip_distance_m = 2e-3}};
  EXPECT_THAT(yielding_names(plant), UnorderedElementsAre("hub", "side", "stem"));
  plant.tips.clear();
  EXPECT_THAT(yielding_names(plant), ElementsAre("stem"));
}

TEST(YieldingBodies, AreNoneOfAnArmWithoutAProbe) {
  Plant plant;
  plant.scene.bodies = {{"forearm", 4, {0, 0, 0}, {0, 0, 0.4}, 0.08}};
  EXPECT_THAT(yielding_bodies(plant), IsEmpty());
}

}  // namespace
}  // namespace sim::testing
