#include "service/run/run_conditions.hpp"

#include <gmock/gmock.h>

#include "tests/config/copied_config.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class Traceability : public CopiedConfig {
 protected:
  std::string digest() const { return configuration_digest(read()).value(); }

  json conditions_json(const Conditions& conditions) const {
    return json::parse(conditions_document(read(), conditions));
  }
};

TEST_F(RunConditionsTest, TheShippedCellsKnowHowWarmTheirBlocksAre) {
  for (const char* name : {"edf", "demo"}) {
    const Cell cell = read_cell(path(std::string("cells/") + name + "/cell.json"));
    EXPECT_EQ(unknown_temperature_reason(cell), std::nullopt) << name;
  }
}

TEST_F(RunConditionsTest, ABlockOfUnknownTemperatureIsToldWithTheRemedy) {
  edit(kBlock, [](json& block) {
    for (const char* key : {"temperature_c", "std_temperature_k", "thermal_expansion_per_k"})
      block.erase(key);
  });
  EXPECT_THAT(temperature_gap(read()).value(), HasSubstr("temperature_c"));
  EXPECT_TRUE(conditions_json({}).at("std_temperature_k").is_null());
}

TEST_F(Traceability, ConditionsTellAllThatIsKnownAndNullForTheRest) {
  const json known = conditions_json({.operator_name = "A. Turing",
                                      .config_digest = digest(),
                                      .controller_application = "touchcal 1.2.3",
                                      .controller_session = 7});
  EXPECT_EQ(known.at("operator"), "A. Turing");
  EXPECT_EQ(known.at("config_digest"), digest());
  EXPECT_EQ(known.at("block_temperature_c"), json_of(path(kBlock)).at("temperature_c"));
  EXPECT_EQ(known.at("block").at("certificate").at("number"), "demo");
  EXPECT_TRUE(known.at("probe").at("certificate").is_null());
  EXPECT_EQ(known.at("versions").at("touchcal"), kVersion);
  EXPECT_EQ(known.at("versions").at("controller_application"), "touchcal 1.2.3");
  const json unknown = conditions_json({});
  ASSERT_EQ(unknown.size(), known.size());
  for (const char* key : {"operator", "config_digest", "controller_session"})
    EXPECT_TRUE(unknown.at(key).is_null()) << key;
}

TEST_F(Traceability, ConditionsTellWhoTouched) {
  EXPECT_TRUE(is_guided(conditions_document(read(), {.touching = Touching::kGuided, .place = {}})));
  EXPECT_FALSE(is_guided(conditions_document(read(), {.touching = Touching::kAutomatic, .place = {}})));
  for (const char* other : {"", "[]", "{}", "{\"touching\":1}", "{"}) EXPECT_FALSE(is_guided(other)) << other;
  EXPECT_FALSE(is_guided(std::nullopt));  // of a run before there were any
}

TEST_F(Traceability, ConditionsTellWhereTheBlockStood) {
  EXPECT_TRUE(conditions_json({}).at("place").is_null());
  LocatedPlace place{.cell_from_block = Eigen::Isometry3d(Eigen::Translation3d(0.03, 0.0, -0.02)),
                     .touches = std::vector<calib::PlaceTouch>(6),
                     .located_at = "2026-11-22T08:00:00.000Z"};
  place.cell_from_block.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  place.covariance.diagonal().setConstant(1e-6);
  const json told = conditions_json({.touching = {}, .place = place}).at("place");
  EXPECT_EQ(told.at("located_at"), place.located_at);
  EXPECT_EQ(told.at("shift_mm"), (json{30.0, 0.0, -20.0}));
  EXPECT_NEAR(told.at("turn_deg")[1].get<double>(), 28.648, 1e-3);
  EXPECT_NEAR(told.at("std_shift_mm")[2].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(told.at("touch_count"), 6);
}

TEST_F(Traceability, TheProbeMayHaveACertificateAsTheBlockHas) {
  edit(kProbe, [](json& probe) { probe["certificate"] = {{"number", "P-7"}}; });
  EXPECT_EQ(read().probe.certificate.at("number"), "P-7");
}

TEST_F(RunConditionsTest, TheCellSaysHowItDecides) {
  EXPECT_FALSE(read().acceptance.guarded);
  edit(kCell, [](json& cell) { cell["acceptance"]["decision"] = "guarded"; });
  EXPECT_TRUE(read().acceptance.guarded);
  edit(kCell, [](json& cell) { cell["acceptance"]["decision"] = "kind"; });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/acceptance/decision");
}

}  // namespace
}  // namespace cell
