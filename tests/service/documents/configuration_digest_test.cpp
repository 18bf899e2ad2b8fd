#include "service/documents/configuration_digest.hpp"

#include <gmock/gmock.h>

#include "tests/config/copied_config.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::MatchesRegex;

class ConfigurationDigest : public CopiedConfig {
 protected:
  std::string digest() const { return configuration_digest(read()).value(); }
};

TEST_F(ConfigurationDigest, TheDigestHangsOnEveryFigureOfEveryFileAndNotOnTheLayout) {
  const std::string shipped = digest();
  EXPECT_THAT(shipped, MatchesRegex("[0-9a-f]{64}"));
  for (const std::string file : {kCell, kArm, kBlock, kProbe, kRecipe}) {
    const json before = json_of(path(file));
    folder_.write(file, before.dump(7));
    EXPECT_EQ(digest(), shipped) << file;
    edit(file, [](json& document) { document["name"] = document["name"].get<std::string>() + "2"; });
    if (file == kRecipe) edit(kCell, [](json& cell) { cell["default_recipe"] = "quick"; });
    EXPECT_NE(digest(), shipped) << file;
    folder_.write(file, before.dump());
    if (file == kRecipe) edit(kCell, [](json& cell) { cell["default_recipe"] = "edf-25"; });
  }
  EXPECT_EQ(digest(), shipped);
}

TEST_F(ConfigurationDigest, HowOftenTheCellIsCheckedAndWhereItsPalletsAreIsNotInIt) {
  edit(kCell, [](json& cell) { cell["schema"] = "touchcal/cell/6"; });
  const std::string before = digest();
  edit(kCell, [](json& cell) {
    cell["schema"] = kCellSchema;
    cell["check_every_days"] = 7;
    cell["target_frames"] = {
        {"pallet", {{"position_mm", {1, 2, 3}}, {"rotation_deg", {0, 0, 0}}, {"touched", "no"}}}};
  });
  EXPECT_EQ(read().check_every, std::chrono::days(7));
  EXPECT_EQ(digest(), before);
}

TEST_F(ConfigurationDigest, ACellThatWasNotReadFromFilesHasNoDigest) {
  EXPECT_EQ(configuration_digest(Cell{}), std::nullopt);
}

}  // namespace
}  // namespace cell
