#include <algorithm>

#include "service/documents/comparison_document.hpp"
#include "service/run/touch_command.hpp"
#include "tests/service/http/routes/routes_bench.hpp"
#include "tests/service/table3_result.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;

class ComparisonRoutesTest : public RoutesTest {
 protected:
  /// With the touches of Table III, joint 3 at each of them further by `offset_rad`.
  std::int64_t calibration(double offset_rad = 0.0, std::optional<std::string> digest = std::nullopt,
                           const std::string& started_at = "start") {
    const std::int64_t run =
        cell_.store().begin_run({.recipe = "edf-25",
                                 .started_at = started_at,
                                 .config_digest = digest ? digest : cell_.operation().config_digest()});
    int number = 0;
    for (calib::Touch touch : table3_touches()) {
      touch.joints[2] += offset_rad;
      cell_.store().append_touch(
          run,
          {.number = ++number, .plane = touch.face + 1, .role = touch.role, .joints = to_wire(touch.joints)});
    }
    cell_.store().finish_run(run, {.verdict = Verdict::kAccepted, .ended_at = "end"});
    return run;
  }
  std::string path(std::int64_t run, const std::string& query) {
    return path_of(run) + "/comparison?" + query;
  }
  ComparisonDocument compared(std::int64_t run, std::int64_t other) {
    const HttpResponse response = get(path(run, "with=" + std::to_string(other)));
    EXPECT_EQ(response.status, 200u) << response.body;
    return read_comparison(response.body);
  }
};

TEST_F(ComparisonRoutesTest, OfTheSameTouchesNothingDiffers) {
  const std::int64_t first = calibration(), second = calibration();
  const ComparisonDocument document = compared(second, first);
  EXPECT_EQ(document.earlier, std::to_string(first));
  EXPECT_EQ(document.later, std::to_string(second));
  EXPECT_EQ(document.verdict.accepted, true);
  EXPECT_NEAR(document.tip_difference_mm.value(), 0.0, 1e-9);
  EXPECT_GT(document.std_tip_difference_mm.value(), 0.001);
  EXPECT_NEAR(document.growth_ppm.value(), 0.0, 1e-6);
  EXPECT_FALSE(document.arm.combinations.empty());
}

TEST_F(ComparisonRoutesTest, TheEarlierOneIsByItsDateAsAnImportedRunGetsANewNumber) {
  const std::int64_t young = calibration(0.0, std::nullopt, "2026-05-02"),
                     old = calibration(0.0, std::nullopt, "2026-01-31");
  for (const ComparisonDocument& document : {compared(young, old), compared(old, young)})
    EXPECT_EQ(document.earlier, std::to_string(old));
}

TEST_F(ComparisonRoutesTest, AnArmWhoseEncoderSlippedHasChangedWhicheverIsNamedFirst) {
  const std::int64_t before = calibration(), after = calibration(1e-3);
  for (const ComparisonDocument& document : {compared(before, after), compared(after, before)}) {
    EXPECT_EQ(document.verdict.accepted, false);
    EXPECT_EQ(document.arm.changed, true);
    EXPECT_EQ(document.tool.changed, false);
    EXPECT_THAT(document.verdict.reasons.at(0), HasSubstr("the arm has changed between run"));
    EXPECT_GT(document.tip_difference_mm.value(), 0.3);
    EXPECT_GT(std::abs(document.arm.combinations.at(0).e_n.value()), 1.0);
  }
}

TEST_F(ComparisonRoutesTest, WhatCannotBeComparedIsRefusedWithTheReason) {
  const std::int64_t run = calibration(), strange = calibration(0.0, "of other files");
  EXPECT_EQ(problem(get(path(run, ""))).at("parameter"), "with");
  for (const std::string& query :
       {std::string("with=0"), std::string("with=x"), "with=" + std::to_string(run)})
    EXPECT_EQ(problem(get(path(run, query))).at("status"), 400) << query;
  EXPECT_EQ(problem(get("/api/v1/runs/99/comparison?with=1")).at("status"), 404);
  const auto refusal = [&](std::int64_t other) {
    const auto told = problem(get(path(run, "with=" + std::to_string(other))));
    EXPECT_EQ(told.at("status"), 409);
    return told.at("detail").get<std::string>();
  };
  const auto unknown = problem(get(path(run, "with=4711")));
  EXPECT_EQ(unknown.at("status"), 404);
  EXPECT_THAT(unknown.at("detail").get<std::string>(), HasSubstr("there is no run 4711"));
  EXPECT_THAT(refusal(strange), HasSubstr("files have changed since run"));
  EXPECT_THAT(refusal(stored_run()), HasSubstr("not a calibration that was accepted"));
}

}  // namespace
}  // namespace cell
