#include "config/probe_tips_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "config/probe_file.hpp"
#include "copied_config.hpp"
#include "probe_with_star.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// The shipped demo probe as a star.
class ProbeTips : public CopiedConfig {
 protected:
  ProbeTips() {
    edit(kProbe, [](json& probe) {
      add_tips(probe,
               {star_tip("left", {40, 0, -20}, {2, 0, 0}), star_tip("back", {0, -40, -20}, {0, -3, 4})});
    });
  }
  [[nodiscard]] Probe probe() const { return read_probe(path(kProbe)); }
  /// The left tip with this in place of what it has, and its ball as it is then.
  [[nodiscard]] ConfigError error_with(const char* key, const json& value) const {
    json document = json_of(path(kProbe));
    json& tip = document["tips"][0];
    tip[key] = value;
    document["bodies"].push_back(ball_of_tip(tip));
    document["bodies"].push_back(stem_of_tip(tip));
    return error_in(document);
  }
  [[nodiscard]] ConfigError error_in(const json& document) const {
    const auto file = folder_.write("probe.json", document.dump());
    return error_of([&] { static_cast<void>(read_probe(file)); });
  }
};

TEST_F(ProbeTips, AreReadInSiUnits) {
  const std::vector<ProbeTip> tips = probe().tips;
  ASSERT_EQ(tips.size(), 2U);
  EXPECT_EQ(tips[0].name, "left");
  EXPECT_TRUE(tips[0].center_m.isApprox(Eigen::Vector3d(0.04, 0.0, -0.02)));
  EXPECT_DOUBLE_EQ(tips[0].within_m, 1e-3);
  EXPECT_DOUBLE_EQ(tips[0].radius_m, 2e-3);
  EXPECT_DOUBLE_EQ(tips[0].std_radius_m, 5e-6);
  EXPECT_TRUE(tips[0].direction.isApprox(Eigen::Vector3d::UnitX())) << "of any length in the file";
  EXPECT_TRUE(tips[1].direction.isApprox(Eigen::Vector3d(0.0, -0.6, 0.8)));
}

TEST_F(ProbeTips, HaveAnExactRadiusWhereItsDeviationIsNotGiven) {
  edit(kProbe, [](json& document) { document["tips"][0].erase("std_radius_mm"); });
  EXPECT_EQ(probe().tips[0].std_radius_m, 0.0);
}

TEST_F(ProbeTips, AreThoseOfTheFourthSchema) {
  json document = json_of(path(kProbe));
  document["schema"] = "touchcal/probe/3";
  const ConfigError old = error_in(document);
  EXPECT_EQ(old.pointer(), "/tips");
  EXPECT_THAT(old.message(), HasSubstr(R"(in a probe of version 3; raise "schema" to 4)"));
}

TEST_F(ProbeTips, HaveNamesOfTheirOwn) {
  EXPECT_THAT(error_with("name", "first").message(), HasSubstr("whose ball is the origin of frame 7"));
  EXPECT_EQ(error_with("name", "first").pointer(), "/tips/0/name");
  EXPECT_THAT(error_with("name", "Left").message(), HasSubstr("of the characters a to z"));
  EXPECT_THAT(error_with("name", "back").message(), HasSubstr("\"back\" is there twice"));
}

TEST_F(ProbeTips, AreOneToEight) {
  json document = json_of(path(kProbe));
  document["tips"] = json::array();
  EXPECT_EQ(error_in(document).pointer(), "/tips");
  json tips = json::array();
  for (int i = 0; i < 9; ++i)
    tips.push_back(star_tip("tip_" + std::to_string(i), {20 + 10 * i, 0, -20}, {1, 0, 0}));
  add_tips(document, tips);
  EXPECT_EQ(error_in(document).pointer(), "/tips");
}

TEST_F(ProbeTips, RefuseWhatNoStylusIs) {
  EXPECT_THAT(error_with("center_mm", {0, 0, -200.1}).message(), HasSubstr("over 200 mm"));
  EXPECT_THAT(error_with("direction", {0, 0, 0}).message(), HasSubstr("is no direction"));
  EXPECT_EQ(error_with("within_mm", 0).pointer(), "/tips/0/within_mm");
  EXPECT_EQ(error_with("within_mm", 5.1).pointer(), "/tips/0/within_mm");
  EXPECT_EQ(error_with("std_radius_mm", -0.001).pointer(), "/tips/0/std_radius_mm");
  EXPECT_EQ(error_with("reach_mm", 3).pointer(), "/tips/0/reach_mm");
  json document = json_of(path(kProbe));
  document["tips"][0]["radius_mm"] = 0;
  EXPECT_EQ(error_in(document).pointer(), "/tips/0/radius_mm");
  document["tips"][0].erase("radius_mm");
  EXPECT_THAT(error_in(document).message(), HasSubstr("\"radius_mm\" is missing"));
}

TEST_F(ProbeTips, RefuseBallsThatCouldTouchEachOther) {
  // Radii of 3 and 2 mm, the centre within 1 mm: 6 mm from the first ball is too near.
  EXPECT_THAT(error_with("center_mm", {5.9, 0, 0}).message(), HasSubstr("touch that of the tip \"first\""));
  json document = json_of(path(kProbe));
  document["tips"][0]["center_mm"] = {6.1, 0, 0};
  document["bodies"].push_back(ball_of_tip(document["tips"][0]));
  document["bodies"].push_back(stem_of_tip(document["tips"][0]));
  EXPECT_NO_THROW(static_cast<void>(read_probe(folder_.write("near.json", document.dump()))));
  // Two radii of 2 mm, both centres within 1 mm.
  const ConfigError error = [&] {
    document["tips"][1]["center_mm"] = {6.1, 5.9, 0};
    document["bodies"].push_back(ball_of_tip(document["tips"][1]));
    return error_in(document);
  }();
  EXPECT_EQ(error.pointer(), "/tips/1");
  EXPECT_THAT(error.message(), HasSubstr("touch that of the tip \"left\""));
}

TEST_F(ProbeTips, HaveTheirBallsAmongTheBodies) {
  const auto error_without_ball = [this](const char* key, const json& value) {
    json document = json_of(path(kProbe));
    document["tips"][0][key] = value;
    return error_in(document);
  };
  const ConfigError elsewhere = error_without_ball("center_mm", {40, 0, -20.0011});
  EXPECT_EQ(elsewhere.pointer(), "/tips/0");
  EXPECT_THAT(elsewhere.message(), HasSubstr("its ball is not among \"bodies\"; add one"));
  EXPECT_THAT(error_without_ball("radius_mm", 2.0011).message(), HasSubstr("its ball is not among"));
  json rounded = json_of(path(kProbe));
  rounded["tips"][0]["center_mm"] = {40, 0, -20.0009};
  EXPECT_NO_THROW(static_cast<void>(read_probe(folder_.write("rounded.json", rounded.dump()))));
  const Probe star = probe();
  EXPECT_EQ(
      std::ranges::count_if(star.bodies, [&](const auto& body) { return is_ball_of(star.tips[0], body); }),
      1);
}

TEST_F(ProbeTips, HaveTheirStemsAmongTheBodies) {
  json document = json_of(path(kProbe));
  json& bodies = document["bodies"];
  bodies.erase(std::ranges::find_if(bodies, [](const json& body) { return body["name"] == "left stem"; }));
  const ConfigError error = error_in(document);
  EXPECT_EQ(error.pointer(), "/tips/0");
  EXPECT_THAT(error.message(), HasSubstr("its stem is not among \"bodies\"; add one that ends within 2 mm"));
}

TEST_F(ProbeTips, HaveBallsThatDoNotTripBeforeTheyTouch) {
  json document = json_of(path(kProbe));
  document["pretravel_mm"] = 2.5;
  EXPECT_THAT(error_in(document).message(), HasSubstr("smaller than \"pretravel_mm\""));
}

/// Nobody knows them better than their balls; the stylus itself is where it is.
TEST_F(ProbeTips, HaveBodiesThatAreAsLooseAsTheirBalls) {
  int loose = 0;
  for (const calib::Capsule& body : probe().bodies) {
    const bool is_of_tip = body.name.starts_with("left") || body.name.starts_with("back");
    EXPECT_EQ(body.loose_m, is_of_tip ? 1e-3 : 0.0) << body.name;
    EXPECT_EQ(body.margin_m, body.loose_m) << body.name;
    if (is_of_tip) ++loose;
  }
  EXPECT_EQ(loose, 4);
}

TEST_F(ProbeTips, StandBesideAFirstTipWithABall) {
  json document = json_of(path(kProbe));
  for (const char* key : {"stylus_radius_mm", "std_stylus_radius_mm", "pretravel_mm", "std_pretravel_mm"})
    document.erase(key);
  document["tip_is_contact_point"] = true;
  const ConfigError error = error_in(document);
  EXPECT_EQ(error.pointer(), "/tips");
  EXPECT_THAT(error.message(), HasSubstr("remove this or tip_is_contact_point"));
}

}  // namespace
}  // namespace cell
