#include "service/setup/arm_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/arm_writer.hpp"
#include "config/config_error.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kShipped = kSourceDir / "config";

TEST(ArmSource, FindsShippedArmsByNameAndOthersByPath) {
  EXPECT_EQ(read_setup_arm({.file = "tx60"}, kShipped).arm.name, "tx60");
  const SetupArm arm = read_setup_arm({.file = (kShipped / "arms/tx90.json").string()}, kShipped);
  EXPECT_EQ(arm.arm.name, "tx90");
  EXPECT_FALSE(arm.is_made);
}

TEST(ArmSource, KnowsAFileThatSetupArmHasMadeByItsBaseWhoseZPointsUp) {
  for (const char* name : {"tx90", "tx60", "three-parallel"})
    EXPECT_FALSE(read_setup_arm({.file = name}, kShipped).is_made) << name;
  const Folder folder;
  std::string table = "theta_deg,d_mm,a_mm,alpha_deg\n";
  for (int row = 0; row < 6; ++row) table += "0,150,100,90\n";
  const ArmChoice by_table{
      .file = "", .dh = folder.write("arm.csv", table).string(), .dh_convention = "standard"};
  const SetupArm made = read_setup_arm(by_table, kShipped);
  const SetupArm read =
      read_setup_arm({.file = folder.write("arm.json", arm_document(made.arm)).string()}, kShipped);
  EXPECT_TRUE(read.is_made);
  EXPECT_LT((read.base_from_frame1.matrix() - made.base_from_frame1.matrix()).norm(), 1e-9);
}

TEST(ArmSource, NamesTheShippedOnesWhereThereIsNone) {
  try {
    read_setup_arm({.file = "tx91"}, kShipped);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("\"tx91\"; shipped are three-parallel, tx60, tx90"));
  }
}

TEST(ArmSource, HasTheRecipesOfANewCell) {
  const auto recipes = shipped_recipes(kShipped);
  EXPECT_EQ(recipes.size(), 2U);
  EXPECT_THAT(recipes.at("quick"), HasSubstr("touchcal/recipe"));
}

TEST(ArmSource, FindsTheConfigurationOfABuildAndOfAnInstalledProgram) {
  const Folder folder;
  EXPECT_EQ(shipped_config_of(kSourceDir / "build/bin/touchcal", nullptr), kShipped);
  std::filesystem::create_directories(folder.path() / "share/touchcal");
  std::filesystem::create_directory_symlink(kShipped, folder.path() / "share/touchcal/config");
  EXPECT_EQ(shipped_config_of(folder.path() / "bin/touchcal", nullptr),
            folder.path() / "share/touchcal/config");
  EXPECT_EQ(shipped_config_of("/none/bin/touchcal", kShipped.c_str()), kShipped);
  EXPECT_THROW(shipped_config_of("/none/bin/touchcal", folder.path().c_str()), ConfigError);
}

}  // namespace
}  // namespace cell
