#include "service/setup/arm_source.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
