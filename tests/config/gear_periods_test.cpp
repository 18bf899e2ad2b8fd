// The periods of the gears' ripple in an arm's file, and the recipe's choice about them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A copy of the shipped cell `demo` whose arm's file is of version 3 and has periods of ripple.
class GearPeriods : public CopiedConfig {
 protected:
  GearPeriods() {
    edit(kArm, [](json& arm) {
      arm["schema"] = "touchcal/arm/3";  // an earlier one is still read
      arm["gears"]["ripple_periods_per_turn"] = json::array({118, nullptr, 96, 72.5, 60, 48});
    });
  }
  ConfigError refusal_of(const std::function<void(json&)>& of_gears) {
    edit(kArm, [&](json& arm) { of_gears(arm["gears"]); });
    return error_of([&] { static_cast<void>(read()); });
  }
};

TEST_F(GearPeriods, AreReadWithTheDeviationsOfCosineAndSineFromTheAmplitudes) {
  const Arm arm = read().arm;
  EXPECT_EQ(arm.model.ripple_periods_per_turn, (std::array{118.0, 0.0, 96.0, 72.5, 60.0, 48.0}));
  const auto std_at = [&](int position) { return arm.nongeometric_std[static_cast<std::size_t>(position)]; };
  EXPECT_EQ(std_at(calib::ripple_position(1)), std::nullopt) << "unknown is not 0";
  EXPECT_DOUBLE_EQ(std_at(calib::ripple_position(3)).value(), 3e-5 / std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(std_at(calib::ripple_position(3) + 1).value(), 3e-5 / std::sqrt(2.0));
  EXPECT_EQ(arm.model.ripples_rad[3].cos, 0.0);
}

TEST_F(GearPeriods, AreNotNeeded) {
  edit(kArm, [](json& arm) { arm["gears"].erase("ripple_periods_per_turn"); });
  const Arm arm = read().arm;
  EXPECT_EQ(arm.model.ripple_periods_per_turn, (std::array<double, calib::kJointCount>{}));
  EXPECT_EQ(arm.nongeometric_std[static_cast<std::size_t>(calib::ripple_position(0))], std::nullopt);
}

TEST_F(GearPeriods, ThatAreNoPeriodsAreRefusedWithTheirPlace) {
  const json good = json::array({118, nullptr, 96, 72.5, 60, 48});
  for (const json& wrong : {json(0), json(1), json(-118), json(20'000), json("NaN"), json(true)}) {
    json periods = good;
    periods[4] = wrong;
    const ConfigError error = refusal_of([&](json& gears) { gears["ripple_periods_per_turn"] = periods; });
    EXPECT_THAT(error.source(), testing::EndsWith(kArm));
    EXPECT_EQ(error.pointer(), "/gears/ripple_periods_per_turn/4") << wrong;
    EXPECT_THAT(error.message(), testing::MatchesRegex(".+; .+")) << wrong;
  }
  const ConfigError five = refusal_of([](json& gears) {
    gears["ripple_periods_per_turn"] = {118, 118, 96, 72, 60};
  });
  EXPECT_EQ(five.pointer(), "/gears/ripple_periods_per_turn");
  EXPECT_THAT(five.message(), HasSubstr("wants 6 entries, has 5"));
}

TEST_F(GearPeriods, OnePeriodATurnIsCalledTheFirstHarmonic) {
  const ConfigError error = refusal_of([](json& gears) { gears["ripple_periods_per_turn"][0] = 1; });
  EXPECT_THAT(error.message(), HasSubstr("std_harmonic_rad"));
}

TEST_F(GearPeriods, WithoutAnAmplitudeAreRefused) {
  EXPECT_THAT(refusal_of([](json& gears) { gears["ripple_rad"][2] = 0; }).message(),
              HasSubstr("/gears/ripple_rad/2"));
  EXPECT_EQ(refusal_of([](json& gears) { gears.erase("ripple_rad"); }).pointer(),
            "/gears/ripple_periods_per_turn/0");
}

TEST_F(GearPeriods, TimesAnAmplitudeThatWouldStopTheJointAreRefused) {
  const ConfigError error = refusal_of([](json& gears) { gears["ripple_rad"][3] = 2e-3; });
  EXPECT_EQ(error.pointer(), "/gears/ripple_periods_per_turn/3");
  EXPECT_THAT(error.message(), HasSubstr("over 0.1"));
}

TEST_F(GearPeriods, AreNeededForAKnownRipple) {
  const auto pairs = [](double of_joint_2) {
    return json::array({{1e-5, 0}, {of_joint_2, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 2e-5}});
  };
  edit(kArm, [&](json& arm) { arm["gears"]["ripples_rad"] = pairs(0); });
  EXPECT_EQ(read().arm.model.ripples_rad[5].sin, 2e-5);
  const ConfigError error = refusal_of([&](json& gears) { gears["ripples_rad"] = pairs(1e-5); });
  EXPECT_EQ(error.pointer(), "/gears/ripples_rad/1");
  EXPECT_THAT(error.message(), HasSubstr("ripple_periods_per_turn"));
}

TEST_F(GearPeriods, AreTriedByItselfUnlessTheRecipeLeavesThemOut) {
  EXPECT_EQ(read().recipes.at("edf-25").identification.ripple, calib::Ripple::kWhenShown) << "version 2";
  edit(kRecipe, [](json& recipe) { recipe["schema"] = "touchcal/recipe/3"; });
  EXPECT_EQ(read().recipes.at("edf-25").identification.ripple, calib::Ripple::kWhenShown);
  edit(kRecipe, [](json& recipe) { recipe["identification"]["ripple"] = "off"; });
  EXPECT_EQ(read().recipes.at("edf-25").identification.ripple, calib::Ripple::kLeaveOut);
  edit(kRecipe, [](json& recipe) { recipe["identification"]["ripple"] = "on"; });
  EXPECT_THAT(error_of([&] { static_cast<void>(read()); }).message(), HasSubstr(R"(give "auto" or "off")"));
}

}  // namespace
}  // namespace cell
