#include "service/documents/conditions_view.hpp"

#include <gmock/gmock.h>

#include "service/base/version.hpp"
#include "service/documents/configuration_digest.hpp"
#include "tests/config/copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;

class ConditionsView : public CopiedConfig {
 protected:
  std::string digest() const { return configuration_digest(read()).value(); }

  json conditions_json(const RunConditions& conditions) const {
    return json::parse(conditions_document(read(), conditions));
  }
};

TEST_F(ConditionsView, ConditionsTellAllThatIsKnownAndNullForTheRest) {
  const json known = conditions_json({.operator_name = "A. Turing",
                                      .config_digest = digest(),
                                      .controller_application = "touchcal 1.2.3",
                                      .controller_session = 7,
                                      .arm_moving_min = 45.0});
  EXPECT_EQ(known.at("arm_moving_min"), 45.0);
  EXPECT_EQ(known.at("operator"), "A. Turing");
  EXPECT_EQ(known.at("config_digest"), digest());
  EXPECT_EQ(known.at("block_temperature_c"), json_of(path(kBlock)).at("temperature_c"));
  EXPECT_EQ(known.at("block").at("certificate").at("number"), "demo");
  EXPECT_TRUE(known.at("probe").at("certificate").is_null());
  EXPECT_EQ(known.at("versions").at("touchcal"), kVersion);
  EXPECT_EQ(known.at("versions").at("controller_application"), "touchcal 1.2.3");
  const json unknown = conditions_json({});
  ASSERT_EQ(unknown.size(), known.size());
  for (const char* key : {"operator", "config_digest", "controller_session", "arm_moving_min"})
    EXPECT_TRUE(unknown.at(key).is_null()) << key;
}

TEST_F(ConditionsView, ConditionsTellTheQualificationThatCountsAndItsNoiseIsReadAgain) {
  const RunConditions qualified{.qualified = QualifiedNoise{12, {12.5e-6, 9.0}}};
  const json told = conditions_json(qualified).at("qualification");
  EXPECT_EQ(told.at("run_id"), "12");
  const auto noise = qualified_noise(conditions_document(read(), qualified)).value();
  EXPECT_DOUBLE_EQ(noise.std_m, 12.5e-6);
  EXPECT_EQ(noise.degrees_of_freedom, 9.0);
  EXPECT_TRUE(conditions_json({}).at("qualification").is_null());
  json old = conditions_json({});
  old.erase("qualification");
  for (const auto& none : {conditions_document(read(), {}), old.dump(), std::string()})
    EXPECT_FALSE(qualified_noise(none));
  EXPECT_FALSE(qualified_noise(std::nullopt));
}

TEST_F(ConditionsView, ConditionsTellTheSerialNumbersOfTheFiles) {
  const json told = conditions_json({});
  EXPECT_EQ(told.at("arm_serial"), json_of(path(kCell)).at("arm_serial"));
  EXPECT_EQ(told.at("controller_serial"), json_of(path(kCell)).at("controller_serial"));
  EXPECT_EQ(told.at("block").at("serial"), json_of(path(kBlock)).at("serial"));
  EXPECT_EQ(told.at("probe").at("serial"), json_of(path(kProbe)).at("serial"));
  for (const char* file : {kCell, kBlock, kProbe}) {
    edit(file, [](json& document) {
      for (const char* key : {"serial", "arm_serial", "controller_serial"}) document.erase(key);
    });
  }
  const json untold = conditions_json({});
  for (const char* pointer : {"/arm_serial", "/controller_serial", "/block/serial", "/probe/serial"})
    EXPECT_TRUE(untold.at(json::json_pointer(pointer)).is_null()) << pointer;
}

TEST_F(ConditionsView, ConditionsOfAnOlderDaemonAreReadWithoutSerialNumbers) {
  json old = conditions_json({});
  for (const char* key : {"arm_serial", "controller_serial"}) old.erase(key);
  for (const char* part : {"block", "probe"}) old.at(part).erase("serial");
  const ConditionsDocument read_back = read_conditions(old.dump());
  EXPECT_EQ(read_back.block.name, old.at("block").at("name").get<std::string>());
  EXPECT_FALSE(read_back.arm_serial || read_back.controller_serial || read_back.block.serial ||
               read_back.probe.serial);
}

TEST_F(ConditionsView, ConditionsTellWhoTouched) {
  EXPECT_TRUE(is_guided(conditions_document(read(), {.touch_mode = TouchMode::kGuided, .place = {}})));
  EXPECT_FALSE(is_guided(conditions_document(read(), {.touch_mode = TouchMode::kAutomatic, .place = {}})));
  for (const char* other : {"", "[]", "{}", "{\"touching\":1}", "{"}) EXPECT_FALSE(is_guided(other)) << other;
  EXPECT_FALSE(is_guided(std::nullopt));  // of a run before there were any
}

TEST_F(ConditionsView, ConditionsTellWhereTheBlockStood) {
  EXPECT_TRUE(conditions_json({}).at("place").is_null());
  BlockPose place{.cell_from_block = Eigen::Isometry3d(Eigen::Translation3d(0.03, 0.0, -0.02)),
                  .touches = std::vector<calib::RegistrationTouch>(6),
                  .located_at = "2026-11-22T08:00:00.000Z"};
  place.cell_from_block.rotate(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
  place.covariance.diagonal().setConstant(1e-6);
  const json told = conditions_json({.touch_mode = {}, .place = place}).at("place");
  EXPECT_EQ(told.at("located_at"), place.located_at);
  EXPECT_EQ(told.at("shift_mm"), (json{30.0, 0.0, -20.0}));
  EXPECT_NEAR(told.at("turn_deg")[1].get<double>(), 28.648, 1e-3);
  EXPECT_NEAR(told.at("std_shift_mm")[2].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(told.at("touch_count"), 6);
}

TEST_F(ConditionsView, StoredConditionsSayWhetherTheBlockWasFound) {
  EXPECT_FALSE(names_place(std::nullopt));
  EXPECT_FALSE(names_place("no json"));
  EXPECT_FALSE(names_place(conditions_document(read(), {})));
  RunConditions found;
  found.place.emplace();
  found.place->cell_from_block.setIdentity();
  EXPECT_TRUE(names_place(conditions_document(read(), found)));
}

TEST_F(ConditionsView, StoredConditionsSayWhetherTheBlockStoodAtAPlace) {
  RunConditions found;
  found.place.emplace();
  found.place->cell_from_block.setIdentity();
  found.place->located_at = "2026-11-22T08:00:00.000Z";
  const std::string there = conditions_document(read(), found), of_file = conditions_document(read(), {});
  EXPECT_TRUE(stood_at(there, found.place));
  EXPECT_FALSE(stood_at(there, std::nullopt));
  EXPECT_FALSE(stood_at(of_file, found.place));
  for (const std::optional<std::string>& none :
       {std::optional(of_file), std::optional<std::string>("{}"), std::optional<std::string>()}) {
    EXPECT_TRUE(stood_at(none, std::nullopt));
    EXPECT_FALSE(stood_at(none, found.place));
  }
  BlockPose later = *found.place;
  later.located_at = "2026-11-23T08:00:00.000Z";
  EXPECT_FALSE(stood_at(there, later)) << "located again";
}

TEST_F(ConditionsView, ConditionsTellWhoToldTheTemperatureAndWhen) {
  const json of_file = conditions_json({});
  EXPECT_EQ(of_file.at("block_temperature_source"), "file");
  EXPECT_TRUE(of_file.at("block_temperature_at").is_null());
  const BlockTemperature given{.celsius = 25.0, .std_k = 0.5, .measured_at = std::chrono::sys_days{}};
  const json of_run = json::parse(conditions_document(with_block_temperature(read(), given),
                                                      {.temperature_source = TemperatureSource::kRun}));
  EXPECT_EQ(of_run.at("block_temperature_c"), 25.0);
  EXPECT_EQ(of_run.at("std_temperature_k"), 0.5);
  EXPECT_EQ(of_run.at("block_temperature_source"), "run");
  EXPECT_EQ(of_run.at("block_temperature_at"), "1970-01-01T00:00:00.000Z");
}

TEST_F(ConditionsView, AnUnknownTemperatureHasNoUncertaintyEither) {
  edit(kBlock, [](json& block) {
    for (const char* key : {"temperature_c", "std_temperature_k", "thermal_expansion_per_k"})
      block.erase(key);
  });
  for (const char* key : {"std_temperature_k", "thermal_expansion_per_k", "block_temperature_source"})
    EXPECT_TRUE(conditions_json({}).at(key).is_null()) << key;
}

}  // namespace
}  // namespace cell
