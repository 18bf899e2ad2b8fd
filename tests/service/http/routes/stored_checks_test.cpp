#include "service/http/routes/internal/stored_checks.hpp"

#include <gmock/gmock.h>

#include <optional>
#include <string>

#include "service/documents/verification_document.hpp"
#include "tests/service/shipped_cell.hpp"

namespace cell {
namespace {

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
  static std::string result_with(double offset_mrad, double growth_ppm, bool accepted = true) {
    CheckDocument document;
    document.verdict.accepted = accepted;
    document.joints = {{.joint = 2, .offset_mrad = 0.0}, {.joint = 3, .offset_mrad = offset_mrad}};
    document.growth_ppm = growth_ppm;
    return document_text(document);
  }

  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
};

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

}  // namespace
}  // namespace cell
