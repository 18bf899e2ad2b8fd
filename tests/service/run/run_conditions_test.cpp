#include "service/run/run_conditions.hpp"

#include <gmock/gmock.h>

#include "tests/config/copied_config.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;

using RunConditionsTest = CopiedConfig;

TEST_F(RunConditionsTest, TheProbeMayHaveACertificateAsTheBlockHas) {
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
