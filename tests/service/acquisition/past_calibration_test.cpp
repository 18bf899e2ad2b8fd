#include "service/acquisition/past_calibration.hpp"

#include <gmock/gmock.h>

#include "tests/config/folder.hpp"

namespace cell {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class PastCalibrationOfAStore : public ::testing::Test {
 protected:
  std::int64_t ended(RunKind kind, std::optional<std::int64_t> of_run, Verdict verdict,
                     RunOutcome outcome = RunOutcome::kComplete) {
    const std::int64_t run = store_.begin_run({.kind = kind,
                                               .of_run = of_run,
                                               .recipe = "edf-25",
                                               .touches_total = 1,
                                               .started_at = "start",
                                               .config_digest = kDigest});
    store_.append_touch(run, {.number = 1, .plane = 1, .captured_at = "t"});
    store_.finish_run(run, {.outcome = outcome, .verdict = verdict, .ended_at = "end"});
    return run;
  }
  PastCalibration found(std::int64_t run) {
    return std::get<PastCalibration>(find_calibration(store_, RunKind::kCheck, run, kDigest));
  }
  std::string refused(std::int64_t run, const std::string& digest = kDigest) {
    return std::get<VerificationRefusal>(find_calibration(store_, RunKind::kCheck, run, digest)).message;
  }

  inline static const std::string kDigest = "digest of the files";
  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
};

TEST_F(PastCalibrationOfAStore, HasTheChecksThatMayBeItsReferenceAndNoOther) {
  const std::int64_t calibration = ended(RunKind::kCalibration, {}, Verdict::kAccepted);
  const std::int64_t other = ended(RunKind::kCalibration, {}, Verdict::kAccepted);
  ended(RunKind::kCheck, calibration, Verdict::kNone);
  ended(RunKind::kCheck, other, Verdict::kNone);
  ended(RunKind::kCheck, calibration, Verdict::kNone, RunOutcome::kAborted);
  // It left touches out, or was made while there was a reference.
  ended(RunKind::kCheck, calibration, Verdict::kIncomplete);
  EXPECT_THAT(found(calibration).checks, SizeIs(1));
  ended(RunKind::kCheck, calibration, Verdict::kNone);
  ended(RunKind::kCheck, calibration, Verdict::kAccepted);
  EXPECT_THAT(found(calibration).checks, SizeIs(2));
  EXPECT_THAT(found(calibration).touches, SizeIs(1));
}

TEST_F(PastCalibrationOfAStore, IsRefusedWithTheReason) {
  const std::int64_t calibration = ended(RunKind::kCalibration, {}, Verdict::kAccepted);
  const std::int64_t rejected = ended(RunKind::kCalibration, {}, Verdict::kRejected);
  const std::int64_t check = ended(RunKind::kCheck, calibration, Verdict::kNone);
  EXPECT_THAT(refused(rejected), HasSubstr("not a calibration that was accepted"));
  EXPECT_THAT(refused(check), HasSubstr("is a check"));
  EXPECT_THAT(refused(calibration, "another"), HasSubstr("files have changed"));
  EXPECT_THAT(refused(4711), HasSubstr("there is no run 4711"));
  const auto is_unknown = [this](std::int64_t run) {
    return std::get<VerificationRefusal>(find_calibration(store_, RunKind::kCheck, run, kDigest))
        .is_unknown_run;
  };
  EXPECT_TRUE(is_unknown(4711));
  EXPECT_FALSE(is_unknown(rejected));
  EXPECT_EQ(calibration_of_cell(store_, RunKind::kCheck), calibration);
}

}  // namespace
}  // namespace cell
