#include "service/documents/checks_view.hpp"

#include <gmock/gmock.h>

#include "calib_core/proof/check.hpp"
#include "calib_core/proof/control_chart.hpp"
#include "config/utc_text.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
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
  if (!accepted) {
    check.result.cause = "joint", check.result.joint = 3;
    check.result.verdict.reasons = {"joint 3 has changed"};
  }
  return check;
}

EndedCheck reference_of_day(int day) {
  EndedCheck check = check_of_day(day, 0.0);
  check.run.verdict = Verdict::kNone;
  check.result.verdict.accepted = std::nullopt;
  check.result.reference.count = day;
  check.result.joints.clear();
  check.result.growth_ppm = std::nullopt;
  check.touches = {table3_touches().begin(), table3_touches().begin() + calib::kCheckTouchCount};
  return check;
}

/// Of other touches than all other checks.
EndedCheck other_reference_of_day(int day) {
  EndedCheck check = reference_of_day(day);
  for (calib::Touch& touch : check.touches) touch.joints[1] += 0.1;
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
  return checks_view(calibration_of_day_0(), checks, edf().arm.model, {}, kEpoch);
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
  EXPECT_THAT(document.warnings,
              ElementsAre(AllOf(HasSubstr("run 15: the offset of joint 3 differs by 0.080 mrad"),
                                HasSubstr("check again; if it stays so, find out")),
                          AllOf(HasSubstr("the growth of the arm differs by 8.000 ppm"),
                                HasSubstr("warmer than at those checks"))));
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

TEST(ChecksView, AnArmThatIsColderIsToldToWarmUpAndASmallResidualIsGood) {
  std::vector<EndedCheck> checks = base_checks();
  double rms_mm = 0.010;
  for (EndedCheck& check : checks) check.result.rms_mm = rms_mm += 0.0001;
  checks.push_back(check_of_day(kBaseEnd + 1, 0.0));
  checks.back().result.growth_ppm = -8.0;
  checks.back().result.rms_mm = 0.001;
  const ChecksDocument document = view_of(checks);
  EXPECT_THAT(document.warnings, ElementsAre(AllOf(HasSubstr("differs by -8.000 ppm"), HasSubstr("colder"))));
  checks.back().result.rms_mm = 0.05;
  EXPECT_THAT(view_of(checks).warnings, Contains(HasSubstr("growth does not explain differs by 0.0")));
}

TEST(ChecksView, AnAlarmIsShownAndChangesNothingOfTheOthers) {
  std::vector<EndedCheck> checks = base_checks();
  checks.push_back(check_of_day(kBaseEnd + 1, 0.0));
  const ChecksDocument without = view_of(checks);
  checks.insert(checks.begin() + kBeforeBase + 2, check_of_day(20, 5.0, false));
  checks.insert(checks.end() - 1, check_of_day(21, 4.0, false));
  const ChecksDocument document = view_of(checks);
  EXPECT_EQ(document.count, std::ssize(checks));
  EXPECT_EQ(document.base.count, without.base.count);
  const ChecksDocument::Chart& with = chart(document, "joint_3");
  ASSERT_THAT(with.points, SizeIs(std::size(chart(without, "joint_3").points) + 2));
  EXPECT_EQ(with.centre, chart(without, "joint_3").centre);
  EXPECT_FALSE(with.points.at(2).shewhart_limit) << "the base is not whole there";
  const ChecksDocument::Point& alarm = *(with.points.end() - 2);
  EXPECT_TRUE(alarm.beyond_shewhart);
  EXPECT_FALSE(alarm.weighted_mean || alarm.ewma_limit);
  const ChecksDocument::Point &newest = with.points.back(),
                              &as_without = chart(without, "joint_3").points.back();
  EXPECT_EQ(newest.weighted_mean, as_without.weighted_mean);
  EXPECT_EQ(newest.ewma_limit, as_without.ewma_limit);
  EXPECT_THAT(document.warnings, IsEmpty());
}

TEST(ChecksView, OfANewestCheckThatAlarmsOnlyItsCauseIsTold) {
  std::vector<EndedCheck> checks = base_checks();
  checks.push_back(check_of_day(kBaseEnd + 1, 5.0, false));
  const ChecksDocument document = view_of(checks);
  EXPECT_EQ(document.checks.back().joint, 3);
  EXPECT_THAT(document.warnings, ElementsAre("run 15: joint 3 has changed"));
  checks.push_back(reference_of_day(kBaseEnd + 2));
  checks.back().run.verdict = Verdict::kIncomplete;
  EXPECT_EQ(view_of(checks).warnings, document.warnings) << "one without a verdict takes nothing back";
}

TEST(ChecksView, TheNewestJudgedIsTheLastWithAVerdict) {
  EXPECT_EQ(newest_judged({}), nullptr);
  std::vector<EndedCheck> checks{reference_of_day(1)};
  EXPECT_EQ(newest_judged(checks), nullptr);
  checks.push_back(check_of_day(2, 0.0));
  checks.push_back(check_of_day(3, 0.0, false));
  checks.push_back(reference_of_day(4));
  EXPECT_EQ(newest_judged(checks), &checks[2]);
}

TEST(ChecksView, ACheckThatWasNotTakenIntoTheReferenceIsNone) {
  std::vector<EndedCheck> checks{reference_of_day(1), reference_of_day(2), reference_of_day(3),
                                 reference_of_day(4), reference_of_day(5)};
  checks[2].run.verdict = Verdict::kIncomplete;
  const ChecksDocument document = view_of(checks);
  EXPECT_EQ(document.reference.count, calib::kReferenceCount);
  EXPECT_FALSE(document.checks[2].reference);
  EXPECT_TRUE(document.checks[3].reference);
  EXPECT_FALSE(document.checks[4].reference) << "the reference was whole";
}

TEST(ChecksView, AReferenceCheckThatDoesNotAgreeIsNone) {
  std::vector<EndedCheck> checks{reference_of_day(1), other_reference_of_day(2)};
  const auto references = [&checks] {
    std::vector<bool> told;
    for (const ChecksDocument::Check& check : view_of(checks).checks) told.push_back(check.reference);
    return told;
  };
  EXPECT_THAT(references(), ElementsAre(false, true));
  checks.push_back(reference_of_day(3));
  EXPECT_THAT(references(), ElementsAre(true, false, true));
  EXPECT_EQ(view_of(checks).reference.count, 2);
  checks.push_back(reference_of_day(4));
  checks.push_back(other_reference_of_day(5));
  EXPECT_THAT(references(), ElementsAre(true, false, true, true, false));
}

TEST(ChecksView, TheNewestAreKeptWithTheirPointsAndWhatWasMadeOfAll) {
  std::vector<EndedCheck> checks = base_checks();
  checks.push_back(check_of_day(kBaseEnd + 1, 0.0));
  ChecksDocument document = view_of(checks);
  const ChecksDocument all = document;
  keep_newest(document, checks.size());
  EXPECT_EQ(document_text(document), document_text(all));
  keep_newest(document, 2);
  EXPECT_THAT(document.checks, SizeIs(2));
  EXPECT_EQ(document.count, std::ssize(checks));
  const ChecksDocument::Chart& kept = chart(document, "joint_3");
  ASSERT_THAT(kept.points, SizeIs(2));
  EXPECT_EQ(kept.points.back().run, "15");
  EXPECT_EQ(kept.centre, chart(all, "joint_3").centre);
  // The newest has no point.
  checks.push_back(reference_of_day(kBaseEnd + 2));
  document = view_of(checks);
  keep_newest(document, 1);
  EXPECT_THAT(chart(document, "joint_3").points, IsEmpty());
}

TEST(ChecksView, TheNextCheckIsDueByTheCellsRuleFromTheNewestOne) {
  const auto at = [](const char* time) { return time_from_utc(time).value(); };
  const std::chrono::days every(7);
  const ChecksDocument first =
      checks_view(calibration_of_day_0(), {}, edf().arm.model, every, at("1970-01-08T00:00:00Z"));
  EXPECT_EQ(first.due_at, "1970-01-08T00:00:00.000Z");
  EXPECT_EQ(first.overdue, false);
  EXPECT_EQ(first.every_days, 7);
  const std::vector<EndedCheck> checks = base_checks();
  const ChecksDocument late =
      checks_view(calibration_of_day_0(), checks, edf().arm.model, every, at("1970-01-21T00:00:01Z"));
  EXPECT_EQ(late.due_at, "1970-01-21T00:00:00.000Z");
  EXPECT_EQ(late.overdue, true);
  EXPECT_THAT(late.warnings, IsEmpty()) << "it is told once";
  std::vector<EndedCheck> more = checks;
  more.push_back(reference_of_day(kBaseEnd + 1));
  more.back().run.verdict = Verdict::kIncomplete;
  EXPECT_EQ(
      checks_view(calibration_of_day_0(), more, edf().arm.model, every, at("1970-01-21T00:00:01Z")).due_at,
      late.due_at)
      << "one without a verdict says nothing";
  const ChecksDocument behind =
      checks_view(calibration_of_day_0(), checks, edf().arm.model, every, at("1970-01-13T23:59:59Z"));
  EXPECT_EQ(behind.every_days, 7);
  EXPECT_FALSE(behind.due_at || behind.overdue);
  EXPECT_THAT(behind.warnings, ElementsAre(AllOf(HasSubstr("is not known"), HasSubstr("run 14 ended"))));
  const ChecksDocument without = view_of(checks);
  EXPECT_FALSE(without.due_at || without.overdue || without.every_days);
}

}  // namespace
}  // namespace cell
