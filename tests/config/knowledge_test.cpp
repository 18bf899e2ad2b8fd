// What is known before the first touch, and how it is used: the recipe's options, the prior, the artefact.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib_core/geometry/units.hpp"
#include "config/block_file.hpp"
#include "config/cell.hpp"
#include "config/utc_text.hpp"
#include "copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using testing::EndsWith;

using Knowledge = CopiedConfig;

TEST_F(Knowledge, ARecipeThatSaysNothingMoreIsRobustWeighsColumnsAndHasNoPrior) {
  const calib::IdentificationOptions options = read().recipes.at("edf-25").identification;
  EXPECT_EQ(options.weights, calib::ColumnScaling::kUnitNorm);
  EXPECT_TRUE(options.robust);
  EXPECT_FALSE(options.prior);
  EXPECT_FALSE(options.stiffness);
  EXPECT_TRUE(options.hold_weak);
}

TEST_F(Knowledge, ARecipeChoosesWeightsRobustnessAndPrior) {
  edit(kRecipe, [](json& recipe) {
    recipe["identification"].update({{"weights", "units"}, {"robust", false}, {"prior", true}});
    recipe["identification"]["hold_weak"] = false;
  });
  const calib::IdentificationOptions options = read().recipes.at("edf-25").identification;
  EXPECT_EQ(options.weights, calib::ColumnScaling::kUnits);
  EXPECT_FALSE(options.robust);
  EXPECT_TRUE(options.prior);
  EXPECT_FALSE(options.hold_weak);
}

TEST_F(Knowledge, StiffnessIsIdentifiedOnlyOfAnArmThatTellsItsMassesAndHowStiffItIsThoughtToBe) {
  edit(kRecipe, [](json& recipe) { recipe["identification"]["stiffness"] = "on"; });
  EXPECT_TRUE(read().recipes.at("edf-25").identification.stiffness);
  const auto makes_it_rigid = [](json& arm) {
    arm["gravity"].update({{"compliance_rad_per_nm", {1e-6, 2e-6}}, {"std_compliance_rad_per_nm", {0, 0}}});
  };
  const auto forgets_masses = [](json& arm) { arm.erase("gravity"); };
  for (const std::function<void(json&)>& change :
       {std::function<void(json&)>(makes_it_rigid), std::function<void(json&)>(forgets_masses)}) {
    edit(kArm, change);
    const ConfigError error = error_of([&] { static_cast<void>(read()); });
    EXPECT_THAT(error.source(), EndsWith(kRecipe));
    EXPECT_EQ(error.pointer(), "/identification/stiffness");
    EXPECT_FALSE(read_cell(path(kCell), StiffnessChoice::kOff).recipes.at("edf-25").identification.stiffness)
        << "what outranks the recipe is all that counts";
  }
}

TEST_F(Knowledge, AChoiceThatOutranksTheRecipesDoesNotHideAWrongWord) {
  EXPECT_TRUE(read_cell(path(kCell), StiffnessChoice::kOn).recipes.at("edf-25").identification.stiffness);
  edit(kRecipe, [](json& recipe) { recipe["identification"]["stiffness"] = "perhaps"; });
  const ConfigError error =
      error_of([&] { static_cast<void>(read_cell(path(kCell), StiffnessChoice::kOff)); });
  EXPECT_EQ(error.pointer(), "/identification/stiffness");
}

TEST_F(Knowledge, MassesWithoutAComplianceAreRefused) {
  edit(kArm, [](json& arm) { arm["gravity"].erase("std_compliance_rad_per_nm"); });
  const ConfigError error = error_of([&] { static_cast<void>(read()); });
  EXPECT_EQ(error.pointer(), "/gravity/masses");
  EXPECT_THAT(error.what(), testing::HasSubstr("std_compliance_rad_per_nm"));
  edit(kArm, [](json& arm) {
    arm["gravity"].update({{"compliance_rad_per_nm", {0, 0}}, {"std_compliance_rad_per_nm", {0, 0}}});
  });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/gravity/masses");
  edit(kArm, [](json& arm) { arm["gravity"]["compliance_rad_per_nm"] = {1e-6, 2e-6}; });
  EXPECT_NO_THROW(static_cast<void>(read())) << "a droop that is in the model";
}

TEST_F(Knowledge, StiffnessIsIdentifiedByItselfWhereTheArmAllowsIt) {
  for (const char* given : {"auto", ""}) {
    edit(kRecipe, [&](json& recipe) {
      recipe["identification"].erase("stiffness");
      if (*given != 0) recipe["identification"]["stiffness"] = given;
    });
    EXPECT_TRUE(read().recipes.at("edf-25").identification.stiffness);
  }
  edit(kArm, [](json& arm) { arm.erase("gravity"); });
  EXPECT_FALSE(read().recipes.at("edf-25").identification.stiffness);
}

TEST_F(Knowledge, ARecipeOfTheFirstSchemaSaysTrueOrFalseAndFalseByItself) {
  edit(kRecipe, [](json& recipe) {
    recipe["schema"] = "touchcal/recipe/1";
    recipe["identification"].erase("stiffness");
    recipe["identification"].erase("harmonics");
  });
  EXPECT_FALSE(read().recipes.at("edf-25").identification.stiffness);
  edit(kRecipe, [](json& recipe) { recipe["identification"]["stiffness"] = true; });
  EXPECT_TRUE(read().recipes.at("edf-25").identification.stiffness);
}

double tolerance(const calib::ErrorTolerances& tolerances, const char* name) {
  return tolerances[static_cast<std::size_t>(*calib::error_parameter_index(name))].value();
}

TEST_F(Knowledge, ThePlaceOfTheBlockIsAsUncertainAsTheArmMayMissUnlessTheCellSaysBetter) {
  const Cell miss = read();
  const calib::ErrorTolerances from_miss = prior_tolerances(miss);
  for (const char* name : {"r0", "d1", "r1"})
    EXPECT_EQ(tolerance(from_miss, name), miss.nominal_position_error_m);
  for (const char* name : {"theta0", "alpha1", "theta1"})
    EXPECT_EQ(tolerance(from_miss, name), miss.nominal_position_error_m / calib::kBlockPoseLeverMetres);
  EXPECT_DOUBLE_EQ(tolerance(from_miss, "d3"), 0.3e-3);  // the maker's
  edit(kCell, [](json& cell) {
    cell["unknown_place_std"] = {{"length_mm", 5}, {"angle_rad", 0.004}};
    cell["frames"] = json::parse(R"([{"j":0,"theta_deg":0,"r_mm":149.6,"std":{"r_mm":1}}])");
  });
  const calib::ErrorTolerances given = prior_tolerances(read());
  EXPECT_DOUBLE_EQ(tolerance(given, "r0"), 0.001);  // the file's own
  EXPECT_DOUBLE_EQ(tolerance(given, "d1"), 0.005);
  EXPECT_DOUBLE_EQ(tolerance(given, "alpha1"), 0.004);
}

TEST_F(Knowledge, WhereTheBaseStandsUprightOnTheBlockItsOtherTiltIsOfThePlaceToo) {
  Cell upright = read();
  upright.arm.model.links[1].alpha_rad = 0.0;
  const auto beta1 = static_cast<std::size_t>(calib::error_parameter_index("beta1").value());
  upright.arm.std_errors[beta1].reset();
  EXPECT_EQ(tolerance(prior_tolerances(upright), "beta1"), upright.unknown_place_std.angle_rad);
  upright.arm.model.links[1].alpha_rad = calib::radians_from_degrees(90.0);
  EXPECT_FALSE(prior_tolerances(upright)[beta1]) << "an error of the arm";
}

TEST_F(Knowledge, AcceptanceNeedsNoLimitOnLackOfFitOrTheBox) {
  const AcceptanceLimits silent = read().acceptance;
  EXPECT_EQ(silent.lack_of_fit_p_min, AcceptanceLimits{}.lack_of_fit_p_min);
  EXPECT_FALSE(silent.tip_box_rms_max_m.has_value());
  edit(kCell, [](json& cell) {
    cell["acceptance"].update({{"lack_of_fit_p_min", 0.01}, {"tip_box_rms_max_mm", 0.06}});
  });
  const AcceptanceLimits limits = read().acceptance;
  EXPECT_EQ(limits.lack_of_fit_p_min, 0.01);
  EXPECT_DOUBLE_EQ(limits.tip_box_rms_max_m.value(), 0.06e-3);
}

TEST_F(Knowledge, TheLimitOfAProofIsOfVersion4) {
  EXPECT_FALSE(read().acceptance.proof_rms_max_m);
  edit(kCell, [](json& cell) { cell["acceptance"]["proof_rms_max_mm"] = 0.05; });
  EXPECT_DOUBLE_EQ(read().acceptance.proof_rms_max_m.value(), 0.05e-3);
  edit(kCell, [](json& cell) { cell["acceptance"]["proof_rms_max_mm"] = 0; });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/acceptance/proof_rms_max_mm");
}

TEST_F(Knowledge, TheLimitsOfTheProbeAreOfVersion5) {
  edit(kCell, [](json& cell) { cell["acceptance"].erase("probe"); });
  EXPECT_FALSE(read().acceptance.probe.step_max_m);
  edit(kCell, [](json& cell) { cell["acceptance"]["probe"] = {{"step_max_mm", 0.05}}; });
  const ProbeLimits limits = read().acceptance.probe;
  EXPECT_DOUBLE_EQ(limits.step_max_m.value(), 0.05e-3);
  EXPECT_FALSE(limits.scatter_max_m || limits.run_out_max_m || limits.lobes_max_m);
  edit(kCell, [](json& cell) { cell["schema"] = "touchcal/cell/4"; });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/acceptance/probe");
}

TEST_F(Knowledge, TheArtefactIsTheBlockAndTheBallWithTheirUncertainties) {
  edit(kBlock, [](json& block) {
    block["temperature_c"] = 23;
    block["faces"][1]["place"] = "estimated";
    block["faces"][2].erase("std_offset_mm");
  });
  const calib::ArtefactKnowledge known = artefact_knowledge(read());
  ASSERT_EQ(known.faces.size(), 5U);
  ASSERT_EQ(known.face_uncertainties.size(), 5U);
  EXPECT_FALSE(known.face_uncertainties[0].estimated);
  EXPECT_DOUBLE_EQ(known.face_uncertainties[0].std_offset_m, 5e-6);
  EXPECT_DOUBLE_EQ(known.face_uncertainties[0].std_tilt_rad, 5.8e-5);
  EXPECT_TRUE(known.face_uncertainties[1].estimated);
  EXPECT_EQ(known.face_uncertainties[2].std_offset_m, 0.0);
  EXPECT_EQ(known.lengths.size(), 2U);
  EXPECT_DOUBLE_EQ(known.stylus.radius_m, 0.003);
  EXPECT_DOUBLE_EQ(known.std_radius_m, 5e-6);
  EXPECT_DOUBLE_EQ(known.std_pretravel_m, 2e-6);
  EXPECT_DOUBLE_EQ(known.warmer_than_20_c_k, 3.0);
  EXPECT_EQ(known.std_temperature_k, 1.0);
  EXPECT_DOUBLE_EQ(known.thermal_expansion_per_k, 2.36e-5);
}

TEST_F(Knowledge, ATipThatIsTheContactPointHasNoBallToBeUncertainOf) {
  edit(kCell, [](json& cell) { cell["probe"] = "../edf/probe.json"; });
  const calib::ArtefactKnowledge known = artefact_knowledge(read());
  EXPECT_EQ(known.stylus.radius_m, 0.0);
  EXPECT_EQ(known.std_radius_m, 0.0);
  EXPECT_EQ(known.std_pretravel_m, 0.0);
}

TEST_F(Knowledge, AnUnknownTemperatureStaysUnknown) {
  edit(kBlock, [](json& block) {
    for (const char* key : {"temperature_c", "std_temperature_k", "thermal_expansion_per_k"})
      block.erase(key);
  });
  const Cell cell = read();
  EXPECT_FALSE(cell.block.temperature_c.has_value());
  EXPECT_EQ(artefact_knowledge(cell).warmer_than_20_c_k, 0.0);
  EXPECT_EQ(artefact_knowledge(cell).std_temperature_k, 0.0);
}

TEST_F(Knowledge, ATemperatureMayHaveTheTimeOfItsMeasurementFromTheSecondSchemaOn) {
  const auto give_time = [](json& block) { block["temperature_at"] = "2026-01-31T08:15:30Z"; };
  edit(kBlock, [](json& block) { lower_schema(block, kFirstBlockSchema); });
  EXPECT_FALSE(read().block.temperature_at) << "files of the first are read";
  edit(kBlock, give_time);
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/temperature_at");
  edit(kBlock, [](json& block) { block["schema"] = kBlockSchema; });
  const Block block = read().block;
  EXPECT_EQ(block.temperature_at, time_from_utc("2026-01-31T08:15:30Z"));
  EXPECT_EQ(block.file, path(kBlock));
  edit(kBlock, [](json& changed) { changed["temperature_at"] = "yesterday"; });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/temperature_at");
}

TEST_F(Knowledge, AnExpansionAloneIsForTemperaturesThatComeWithTheRun) {
  edit(kBlock, [](json& block) {
    lower_schema(block, kFirstBlockSchema);
    block.erase("temperature_c");
    block.erase("std_temperature_k");
  });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/thermal_expansion_per_k");
  edit(kBlock, [](json& block) { block["schema"] = kBlockSchema; });
  const Cell cell = read();
  EXPECT_EQ(cell.block.thermal_expansion_per_k, 2.36e-5);
  const calib::ArtefactKnowledge known =
      artefact_knowledge(with_block_temperature(cell, BlockTemperature{.celsius = 25.0, .std_k = 0.5}));
  EXPECT_DOUBLE_EQ(known.warmer_than_20_c_k, 5.0);
  EXPECT_EQ(known.std_temperature_k, 0.5);
  for (const char* key : {"std_temperature_k", "temperature_at"}) {
    edit(kBlock, [&](json& block) {
      block.erase("std_temperature_k");
      block[key] = key == std::string("temperature_at") ? json("2026-01-31T08:15:30Z") : json(1);
    });
    EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), std::string("/") + key);
  }
}

TEST_F(Knowledge, ACellSaysHowLongARunOnHoldKeepsItsConfirmationFromItsSecondSchemaOn) {
  edit(kCell, [](json& cell) { cell["schema"] = kCellSchema; });
  EXPECT_EQ(read().permit_lifetime, std::chrono::minutes(30));
  edit(kCell, [](json& cell) { cell["permit_minutes"] = 5; });
  EXPECT_EQ(read().permit_lifetime, std::chrono::minutes(5));
  for (const json& wrong : {json(0), json(481), json(1.5), json("5")}) {
    edit(kCell, [&](json& cell) { cell["permit_minutes"] = wrong; });
    EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/permit_minutes") << wrong;
  }
}

TEST_F(Knowledge, ACellSaysHowOftenItIsToBeChecked) {
  edit(kCell, [](json& cell) { cell["schema"] = kCellSchema; });
  EXPECT_FALSE(read().check_every);
  edit(kCell, [](json& cell) { cell["check_every_days"] = 7; });
  EXPECT_EQ(read().check_every, std::chrono::days(7));
  for (const json& wrong : {json(0), json(367), json(1.5), json("7"), json(nullptr)}) {
    edit(kCell, [&](json& cell) { cell["check_every_days"] = wrong; });
    EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/check_every_days") << wrong;
  }
}

TEST_F(Knowledge, ACellSaysHowOldATemperatureMayBeFromItsSecondSchemaOn) {
  edit(kCell, [](json& cell) {
    lower_schema(cell, kFirstCellSchema);
    cell["acceptance"].erase("tip_box_max_mm");
    cell["acceptance"].erase("tip_box_max_by_recipe_mm");
  });
  EXPECT_FALSE(read().acceptance.tip_box_max_m) << "files of the first are read";
  EXPECT_EQ(read().block_temperature_age_max, std::chrono::hours(8));
  edit(kCell, [](json& cell) { cell["block_temperature_age_max_h"] = 1.5; });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/block_temperature_age_max_h");
  edit(kCell, [](json& cell) { cell["schema"] = kCellSchema; });
  EXPECT_EQ(read().block_temperature_age_max, std::chrono::minutes(90));
  for (const double wrong : {0.0, -1.0, 9000.0}) {
    edit(kCell, [&](json& cell) { cell["block_temperature_age_max_h"] = wrong; });
    EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/block_temperature_age_max_h")
        << wrong;
  }
}

TEST_F(Knowledge, ACellLimitsTheTipAtItsWorstFromItsSecondSchemaOn) {
  const Cell shipped = read();
  ASSERT_TRUE(shipped.acceptance.tip_box_max_m);
  EXPECT_LT(*shipped.acceptance.tip_box_max_m, shipped.nominal_position_error_m) << "else it says nothing";
  edit(kCell, [](json& cell) { lower_schema(cell, kFirstCellSchema); });
  EXPECT_EQ(error_of([&] { static_cast<void>(read()); }).pointer(), "/acceptance/tip_box_max_mm");
}

TEST_F(Knowledge, ACellLimitsTheTipByRecipeFromItsThirdSchemaOn) {
  const auto limit_to = [this](const json& by_recipe) {
    edit(kCell, [&](json& cell) {
      cell["schema"] = kCellSchema;
      cell["acceptance"]["tip_box_max_by_recipe_mm"] = by_recipe;
    });
  };
  limit_to({{"quick", 0.4}, {"best", 0.25}});
  const AcceptanceLimits limits = read().acceptance;
  EXPECT_DOUBLE_EQ(limits.tip_box_max_of_m("quick").value(), 4e-4);
  EXPECT_DOUBLE_EQ(limits.tip_box_max_of_m("best").value(), 2.5e-4);
  EXPECT_EQ(limits.tip_box_max_of_m("edf-23"), limits.tip_box_max_m);
  for (const auto& [wrong, said] : {std::pair{json{{"quik", 0.4}}, "no recipe of this cell is called"},
                                    std::pair{json{{"quick", 0}}, "over 0"}}) {
    limit_to(wrong);
    const ConfigError error = error_of([&] { static_cast<void>(read()); });
    EXPECT_EQ(error.pointer(), "/acceptance/tip_box_max_by_recipe_mm/" + wrong.begin().key());
    EXPECT_THAT(error.message(), testing::HasSubstr(said));
  }
  limit_to({{"quick", 0.4}});
  edit(kCell, [](json& cell) { lower_schema(cell, kSecondCellSchema); });
  const ConfigError older = error_of([&] { static_cast<void>(read()); });
  EXPECT_EQ(older.pointer(), "/acceptance/tip_box_max_by_recipe_mm");
  EXPECT_THAT(older.message(), testing::HasSubstr("version 2; raise \"schema\" to 3"));
}

}  // namespace
}  // namespace cell
