#include "service/documents/checks_view.hpp"

#include <gmock/gmock.h>

#include "calib_core/proof/check.hpp"
#include "calib_core/proof/control_chart.hpp"
#include "config/utc_text.hpp"

namespace cell {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

constexpr std::chrono::system_clock::time_point kEpoch{};
constexpr int kBeforeBase = calib::kReferenceCount;
constexpr int kBaseEnd = kBeforeBase + calib::kChartBaseCount;

StoredRun calibration_of_day_0() { return {.id = 1, .ended_at = "1970-01-01T00:00:00.000Z"}; }

/// A check with a verdict, of which joint 3 and the growth are `offset_mrad` and 100 times as many ppm.
EndedCheck check_of_day(int day, double offset_mrad, bool accepted = true) {
  EndedCheck check{.run = {.id = 1 + day,
                           .ended_at = "1970-01-" + std::string(day < 9 ? "0" : "") +
                                       std::to_string(day + 1) + "T00:00:00.000Z",
                           .verdict = accepted ? Verdict::kAccepted : Verdict::kRejected},
                   .result = {}};
  check.result.verdict.accepted = accepted;
  check.result.reference = {.count = calib::kReferenceCount, .needed = calib::kReferenceCount};
  check.result.joints = {{.joint = 2, .offset_mrad = 0.0}, {.joint = 3, .offset_mrad = offset_mrad}};
  check.result.growth_ppm = 100.0 * offset_mrad;
  if (!accepted) check.result.cause = "joint", check.result.joint = 3;
  return check;
}

EndedCheck reference_of_day(int day) {
  EndedCheck check = check_of_day(day, 0.0);
  check.run.verdict = Verdict::kNone;
  check.result.verdict.accepted = std::nullopt;
  check.result.reference.count = day;
  check.result.joints.clear();
  check.result.growth_ppm = std::nullopt;
  return check;
}

/// The reference, and as many checks as the limits are from, of a joint that scatters by 0.01 mrad.
std::vector<EndedCheck> base_checks() {
  std::vector<EndedCheck> checks;
  for (int day = 1; day <= kBaseEnd; ++day)
    checks.push_back(day <= kBeforeBase ? reference_of_day(day)
                                        : check_of_day(day, day % 2 == 0 ? 0.01 : -0.01));
  return checks;
}

const ChecksDocument::Chart& chart(const ChecksDocument& document, const std::string& quantity) {
  return *std::ranges::find(document.charts, quantity, &ChecksDocument::Chart::quantity);
}

ChecksDocument view_of(const std::vector<EndedCheck>& checks) {
  return checks_view(calibration_of_day_0(), checks, {}, kEpoch);
}

TEST(ChecksView, OfNoCheckHasEmptyCharts) {
  const ChecksDocument document = view_of({});
  EXPECT_EQ(document.of_run, "1");
  EXPECT_THAT(document.checks, IsEmpty());
  EXPECT_THAT(document.charts, SizeIs(6));
  EXPECT_THAT(document.charts, Each(Field(&ChecksDocument::Chart::points, IsEmpty())));
  EXPECT_EQ(document.base.count, 0);
}

TEST(ChecksView, ReferencesAreListedAndInNoChart) {
  const ChecksDocument document = view_of(base_checks());
  EXPECT_THAT(document.checks, SizeIs(kBaseEnd));
  EXPECT_EQ(document.reference.count, calib::kReferenceCount);
  EXPECT_EQ(document.base.count, calib::kChartBaseCount);
  EXPECT_THAT(chart(document, "joint_3").points, SizeIs(calib::kChartBaseCount));
  EXPECT_THAT(chart(document, "joint_5").points, IsEmpty()) << "nothing was told of it";
  EXPECT_FALSE(chart(document, "joint_3").centre) << "the base has no limits of its own";
  EXPECT_THAT(document.warnings, IsEmpty());
}

TEST(ChecksView, AJumpOfTheNewestCheckIsWarnedOfWithItsFigure) {
  std::vector<EndedCheck> checks = base_checks();
  checks.push_back(check_of_day(kBaseEnd + 1, 0.08));
  const ChecksDocument document = view_of(checks);
  const ChecksDocument::Point& newest = chart(document, "joint_3").points.back();
  EXPECT_TRUE(newest.beyond_shewhart);
  EXPECT_NEAR(chart(document, "joint_3").centre.value(), 0.0, 1e-12);
  EXPECT_LT(newest.shewhart_limit.value(), 0.08);
  EXPECT_THAT(document.warnings, ElementsAre(HasSubstr("run 15: the offset of joint 3 differs by 0.080 mrad"),
                                             HasSubstr("the growth of the arm differs by 8.000 ppm")));
  checks.push_back(check_of_day(kBaseEnd + 2, 0.0));
  EXPECT_FALSE(chart(view_of(checks), "joint_3").points.back().beyond_shewhart);
}

TEST(ChecksView, ACreepIsWarnedOfBeforeOneCheckIsStriking) {
  std::vector<EndedCheck> checks = base_checks();
  for (int day = kBaseEnd + 1; view_of(checks).warnings.empty(); ++day) {
    ASSERT_LT(day, 31);
    checks.push_back(check_of_day(day, 0.02));
  }
  const ChecksDocument document = view_of(checks);
  EXPECT_THAT(document.warnings.front(), HasSubstr("joint 3 creeps"));
  EXPECT_FALSE(chart(document, "joint_3").points.back().beyond_shewhart);
}

TEST(ChecksView, AnAlarmBeforeTheBaseIsWholeMakesNoLimitsWide) {
  std::vector<EndedCheck> checks = base_checks();
  checks.insert(checks.begin() + kBeforeBase + 2, check_of_day(20, 5.0, false));
  const ChecksDocument without = view_of(base_checks()), document = view_of(checks);
  EXPECT_THAT(chart(document, "joint_3").points, SizeIs(calib::kChartBaseCount));
  EXPECT_EQ(document.checks.at(kBeforeBase + 2).accepted, false);
  EXPECT_EQ(document.checks.at(kBeforeBase + 2).joint, 3);
  checks.push_back(check_of_day(21, 4.0, false));
  EXPECT_THAT(chart(view_of(checks), "joint_3").points, SizeIs(calib::kChartBaseCount + 1))
      << "behind the base it is shown";
  EXPECT_EQ(without.base.count, document.base.count);
}

TEST(ChecksView, TheNextCheckIsDueByTheCellsRuleFromTheNewestOne) {
  const auto at = [](const char* time) { return time_from_utc(time).value(); };
  const std::chrono::days every(7);
  const ChecksDocument first = checks_view(calibration_of_day_0(), {}, every, at("1970-01-08T00:00:00Z"));
  EXPECT_EQ(first.due_at, "1970-01-08T00:00:00.000Z");
  EXPECT_EQ(first.overdue, false);
  EXPECT_EQ(first.every_days, 7);
  const std::vector<EndedCheck> checks = base_checks();
  const ChecksDocument late = checks_view(calibration_of_day_0(), checks, every, at("1970-01-21T00:00:01Z"));
  EXPECT_EQ(late.due_at, "1970-01-21T00:00:00.000Z");
  EXPECT_EQ(late.overdue, true);
  EXPECT_THAT(late.warnings, ElementsAre(HasSubstr("a check was due on 1970-01-21")));
  const ChecksDocument without = view_of(checks);
  EXPECT_FALSE(without.due_at || without.overdue || without.every_days);
}

}  // namespace
}  // namespace cell
