#include "service/documents/check_warmth.hpp"

#include <gmock/gmock.h>

#include "service/documents/verification_document.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

CheckDocument quiet_check() {
  CheckDocument check{.arm = "tx90", .of_run = "3", .touch_count = 12, .complete = true};
  check.verdict.accepted = true;
  check.growth_ppm = 80.0;
  return check;
}

std::string why_no_warmth(const std::string& result, const std::string& of_run = "3") {
  const auto found = warmth_of("9", "then", result, of_run);
  const auto* why = std::get_if<std::string>(&found);
  return why ? *why : "";
}

TEST(CheckWarmth, IsTheGrowthThatAQuietCheckFound) {
  const auto found = warmth_of("9", "then", document_text(quiet_check()), "3");
  const CheckWarmth& warmth = std::get<CheckWarmth>(found);
  EXPECT_EQ(warmth.check_run_id, "9");
  EXPECT_EQ(warmth.at, "then");
  EXPECT_DOUBLE_EQ(warmth.growth, 80e-6);
}

TEST(CheckWarmth, OfAnotherRunWithoutAVerdictOrWithAnAlarmThereIsNone) {
  EXPECT_THAT(why_no_warmth(document_text(ProofDocument())), HasSubstr("run 9 is no check"));
  EXPECT_THAT(why_no_warmth("{}"), HasSubstr("run 9 is no check"));
  EXPECT_THAT(why_no_warmth(document_text(quiet_check()), "4"), HasSubstr("touchcal check --of 4"));
  CheckDocument check = quiet_check();
  check.verdict.accepted.reset();
  EXPECT_THAT(why_no_warmth(document_text(check)), HasSubstr("has no verdict"));
  check.verdict.accepted = false;
  EXPECT_THAT(why_no_warmth(document_text(check)), HasSubstr("more than the arm's warmth"));
  check.verdict.accepted = true;
  check.growth_ppm.reset();
  EXPECT_THAT(why_no_warmth(document_text(check)), HasSubstr("has no verdict"));
}

TEST(CheckWarmth, MakesTheLengthsOfTheArmLongerAndNothingElse) {
  const Arm arm = edf().arm, warm = grown(arm, {.check_run_id = "9", .at = "then", .growth = 100e-6});
  EXPECT_NEAR(warm.model.links[3].d_m / arm.model.links[3].d_m, 1.0001, 1e-9);
  EXPECT_NEAR(warm.model.links[4].r_m / arm.model.links[4].r_m, 1.0001, 1e-9);
  EXPECT_EQ(warm.model.links[7].r_m, arm.model.links[7].r_m) << "the probe is no part of the arm";
  for (std::size_t i = 0; i < arm.model.links.size(); ++i)
    EXPECT_EQ(warm.model.links[i].theta_rad, arm.model.links[i].theta_rad) << i;
}

}  // namespace
}  // namespace cell
