#include "service/http/routes/internal/stored_checks.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "calib_core/proof/check.hpp"
#include "calib_core/proof/control_chart.hpp"
#include "config/utc_text.hpp"
#include "service/documents/model_document.hpp"
#include "service/documents/verification_document.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

using ::testing::AllOf;
using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::Gt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Lt;
using ::testing::Optional;
using ::testing::Pair;
using ::testing::SizeIs;

class StoredChecksTest : public ::testing::Test {
 protected:
  std::int64_t ended_run(const NewRun& begun, const RunEnd& end) {
    const std::int64_t run = store_.begin_run(begun);
    store_.finish_run(run, end);
    return run;
  }
  std::int64_t accepted_calibration(const std::string& ended_at = "2026-05-01T00:00:00.000Z") {
    return ended_run({.recipe = "edf-25", .started_at = "start"},
                     {.verdict = Verdict::kAccepted, .ended_at = ended_at});
  }
  std::int64_t ended_check(std::int64_t calibration, const std::string& ended_at, Verdict verdict,
                           const std::optional<std::string>& result) {
    return ended_run(
        {.kind = RunKind::kCheck, .of_run = calibration, .recipe = "edf-25", .started_at = "start"},
        {.verdict = verdict, .ended_at = ended_at, .result_json = result});
  }
  std::int64_t ended_reference(std::int64_t calibration, const std::string& ended_at) {
    const std::int64_t run = store_.begin_run(
        {.kind = RunKind::kCheck, .of_run = calibration, .recipe = "edf-25", .started_at = "start"});
    for (int number = 1; number <= calib::kCheckTouchCount; ++number)
      store_.append_touch(run, {.number = number, .plane = 1, .captured_at = "t"});
    store_.finish_run(run, {.verdict = Verdict::kNone, .ended_at = ended_at, .result_json = "{}"});
    return run;
  }
  static std::string result_with(double offset_mrad, double growth_ppm, bool accepted = true) {
    CheckDocument document;
    document.verdict.accepted = accepted;
    document.joints = {{.joint = 2, .offset_mrad = 0.0}, {.joint = 3, .offset_mrad = offset_mrad}};
    document.growth_ppm = growth_ppm;
    return document_text(document);
  }
  /// The calibration is run 1.
  void approve_model_with(const std::string& serial) {
    ModelDocument model{.run_id = std::to_string(accepted_calibration()),
                        .arm = cell_.arm.name,
                        .arm_serial = serial,
                        .tip_uncertainty = {},
                        .parameters = {},
                        .nongeometric_parameters = {}};
    ModelStore(store_.database())
        .approve({.run_id = 1,
                  .at = "2026-05-02T00:00:00.000Z",
                  .hash = "hash",
                  .document = document_text(model),
                  .arm_json = "{}"});
  }
  FoundFigures found() const {
    return cell_figures(store_, cell_, time_from_utc("2026-05-10T00:00:00Z").value());
  }

  Cell cell_;
  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
};

CellFigures::Time at(const char* text) { return time_from_utc(text).value(); }

constexpr const char* kFirstOfMay = "2026-05-01T00:00:00.000Z";

TEST_F(StoredChecksTest, OfACalibrationAreThoseThatCameToTheirEndOldestFirst) {
  const std::int64_t other = accepted_calibration(), calibration = accepted_calibration();
  ended_check(other, "2026-05-02T00:00:00.000Z", Verdict::kAccepted, result_with(0.1, 1.0));
  const std::int64_t first =
      ended_check(calibration, "2026-05-03T00:00:00.000Z", Verdict::kAccepted, result_with(0.2, 2.0));
  const std::int64_t unread = ended_check(calibration, "2026-05-04T00:00:00.000Z", Verdict::kIncomplete,
                                          R"({"schema":"touchcal/check/9"})");
  const std::int64_t without =
      ended_check(calibration, "2026-05-05T00:00:00.000Z", Verdict::kIncomplete, std::nullopt);
  const auto checks = checks_of(store_, calibration);
  ASSERT_THAT(checks, SizeIs(3));
  EXPECT_EQ(checks[0].run.id, first);
  EXPECT_EQ(checks[0].result.growth_ppm, 2.0);
  EXPECT_EQ(checks[1].run.id, unread);
  EXPECT_EQ(checks[2].run.id, without);
  for (const std::size_t place : {1u, 2u}) EXPECT_FALSE(checks[place].result.verdict.accepted) << place;
}

TEST_F(StoredChecksTest, OneThatWasImportedBehindNewerOnesIsOlder) {
  const std::int64_t calibration = accepted_calibration(kFirstOfMay);
  const std::int64_t newer =
      ended_check(calibration, "2026-05-04T00:00:00.000Z", Verdict::kAccepted, result_with(0.1, 10.0));
  const std::int64_t older =
      ended_check(calibration, "2026-05-02T00:00:00.000Z", Verdict::kRejected, result_with(0.2, 20.0, false));
  EXPECT_EQ(found().figures.is_unchanged, true);
  EXPECT_EQ(found().figures.checked_at, at("2026-05-04T00:00:00Z"));
  const auto runs_until = [&](std::int64_t run) {
    std::vector<std::int64_t> runs;
    for (const EndedCheck& check : checks_until(store_, calibration, store_.run(run).value()))
      runs.push_back(check.run.id);
    return runs;
  };
  EXPECT_THAT(runs_until(older), ElementsAre(older));
  EXPECT_THAT(runs_until(newer), ElementsAre(older, newer));
  const std::int64_t under_way = store_.begin_run(
      {.kind = RunKind::kCheck, .of_run = calibration, .recipe = "edf-25", .started_at = "start"});
  EXPECT_THAT(runs_until(under_way), ElementsAre(older, newer));
}

TEST_F(StoredChecksTest, FiguresOfNothingAreUnknown) {
  const auto [figures, trouble] = found();
  EXPECT_FALSE(trouble) << *trouble;
  EXPECT_FALSE(figures.checked_at || figures.check_due_at || figures.arm_growth || figures.is_proved ||
               figures.model_approved_at || figures.is_model_of_this_arm);
  EXPECT_THAT(figures.joint_offsets_rad, IsEmpty());
  EXPECT_THAT(figures.limit_ratios, IsEmpty());
  EXPECT_THAT(figures.certificate_ends, IsEmpty());
}

TEST_F(StoredChecksTest, FiguresAreOfTheNewestCheckWithAVerdict) {
  cell_.check_every = std::chrono::days(7);
  const std::int64_t calibration = accepted_calibration(kFirstOfMay);
  EXPECT_EQ(found().figures.check_due_at, at("2026-05-08T00:00:00Z")) << "as there is no check";
  EXPECT_FALSE(found().figures.checked_at);
  ended_reference(calibration, "2026-05-02T00:00:00.000Z");
  EXPECT_EQ(found().figures.checked_at, at("2026-05-02T00:00:00Z")) << "it is of the reference";
  EXPECT_FALSE(found().figures.arm_growth);
  ended_check(calibration, "2026-05-03T00:00:00.000Z", Verdict::kAccepted, result_with(0.1, 10.0));
  ended_check(calibration, "2026-05-04T00:00:00.000Z", Verdict::kRejected, result_with(0.25, 40.0, false));
  ended_check(calibration, "2026-05-05T00:00:00.000Z", Verdict::kIncomplete, std::nullopt);
  const CellFigures figures = found().figures;
  EXPECT_EQ(figures.checked_at, at("2026-05-04T00:00:00Z")) << "the last one says nothing";
  EXPECT_THAT(figures.joint_offsets_rad, ElementsAre(Pair(2, 0.0), Pair(3, DoubleEq(0.25e-3))));
  EXPECT_THAT(figures.arm_growth, Optional(DoubleEq(40e-6)));
  EXPECT_THAT(figures.limit_ratios, IsEmpty()) << "the base of the charts is not whole";
  const std::int64_t newer = accepted_calibration("2026-05-06T00:00:00.000Z");
  EXPECT_THAT(found().figures.joint_offsets_rad, IsEmpty()) << "of another calibration than " << newer;
}

TEST_F(StoredChecksTest, ARatioIsThatOfTheNearerLimitAndOverOneBeyondIt) {
  const std::int64_t calibration = accepted_calibration(kFirstOfMay);
  const auto check = [&](double offset_mrad) {
    ended_check(calibration, "2026-05-02T00:00:00.000Z", Verdict::kAccepted, result_with(offset_mrad, 0.0));
    return found().figures.limit_ratios;
  };
  for (int count = 0; count < calib::kChartBaseCount; ++count) check(count % 2 == 0 ? 0.01 : -0.01);
  const auto quiet = check(0.01);
  EXPECT_THAT(quiet, ElementsAre(Pair("joint_3", AllOf(Gt(0.0), Lt(1.0)))))
      << "what does not vary at all has no limit";
  EXPECT_GT(check(0.2).at("joint_3"), 1.0) << "the point";
  EXPECT_GT(check(0.02).at("joint_3"), 1.0) << "its weighted mean, which remembers";
}

TEST_F(StoredChecksTest, AProofThatSaysNothingTakesNothingBack) {
  const std::int64_t calibration = accepted_calibration(kFirstOfMay);
  const auto prove = [&](Verdict verdict) {
    ended_run({.kind = RunKind::kProof, .of_run = calibration, .recipe = "edf-25", .started_at = "start"},
              {.verdict = verdict, .ended_at = "2026-05-02T00:00:00.000Z"});
    return found().figures.is_proved;
  };
  EXPECT_EQ(prove(Verdict::kIncomplete), std::nullopt);
  EXPECT_EQ(prove(Verdict::kAccepted), true);
  EXPECT_EQ(prove(Verdict::kRejected), false);
  EXPECT_EQ(prove(Verdict::kIncomplete), false);
}

TEST_F(StoredChecksTest, TheApprovedModelIsHeldAgainstTheSerialNumberOfTheCell) {
  approve_model_with("4711");
  EXPECT_EQ(found().figures.model_approved_at, at("2026-05-02T00:00:00Z"));
  EXPECT_EQ(found().figures.is_model_of_this_arm, std::nullopt) << "the cell's file has none";
  cell_.arm_serial = "4711";
  EXPECT_EQ(found().figures.is_model_of_this_arm, true);
  cell_.arm_serial = "4712";
  EXPECT_EQ(found().figures.is_model_of_this_arm, false);
  cell_.arm_serial.reset();
  cell_.arm.name = "another";
  EXPECT_EQ(found().figures.is_model_of_this_arm, false) << "whatever its number is";
}

TEST_F(StoredChecksTest, WhatCannotBeReadIsUnknownAndTheRestIsNot) {
  cell_.probe.certificate = {{"valid_until", "2026-05-31"}};
  approve_model_with("4711");
  ended_check(1, "2026-05-03T00:00:00.000Z", Verdict::kAccepted, result_with(0.1, 10.0));
  ASSERT_EQ(store_.database()->exec("UPDATE runs SET ended_at = 'x' WHERE kind = 'check'"), 1);
  const auto [figures, trouble] = found();
  EXPECT_THAT(trouble, Optional(HasSubstr("run 2")));
  EXPECT_FALSE(figures.checked_at || figures.arm_growth);
  EXPECT_TRUE(figures.model_approved_at);
  EXPECT_THAT(figures.certificate_ends, ElementsAre(Pair("probe", at("2026-06-01T00:00:00Z"))));
}

}  // namespace
}  // namespace cell
