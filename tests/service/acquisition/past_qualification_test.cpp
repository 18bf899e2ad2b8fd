#include "service/acquisition/past_qualification.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "config/utc_text.hpp"
#include "service/documents/conditions_view.hpp"
#include "service/documents/qualification_document.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

using namespace std::chrono_literals;

class PastQualificationOfAStore : public ::testing::Test {
 protected:
  std::int64_t ended(Verdict verdict, const std::string& ended_at, double scatter_um = 12.5,
                     RunOutcome outcome = RunOutcome::kComplete, RunKind kind = RunKind::kQualification) {
    const std::int64_t run = store_.begin_run({.kind = kind,
                                               .of_run = {},
                                               .recipe = "edf-25",
                                               .touches_total = 1,
                                               .started_at = "start",
                                               .config_digest = kDigest});
    QualificationDocument document;
    document.scatter = {.std_um = scatter_um, .degrees_of_freedom = 9.0};
    store_.finish_run(run, {.outcome = outcome,
                            .verdict = verdict,
                            .ended_at = ended_at,
                            .result_json = document_text(document)});
    return run;
  }
  std::optional<QualifiedNoise> found(const std::optional<std::string>& digest = kDigest,
                                      std::chrono::hours later = 1h) {
    return qualification_that_counts(store_, digest, *time_from_utc(kEnded) + later);
  }

  static constexpr const char* kEnded = "2026-11-28T08:00:00.000Z";
  inline static const std::string kDigest = "digest of the files";
  Folder folder_;
  RunStore store_{folder_.path() / "touchcal.sqlite"};
};

TEST_F(PastQualificationOfAStore, TellsWhatTheNewestMeasured) {
  EXPECT_FALSE(found());
  ended(Verdict::kAccepted, kEnded, 20.0);
  const std::int64_t newest = ended(Verdict::kAccepted, kEnded);
  ended(Verdict::kIncomplete, kEnded, 40.0, RunOutcome::kAborted);
  ended(Verdict::kAccepted, kEnded, 50.0, RunOutcome::kComplete, RunKind::kCalibration);
  const auto counts = found().value();
  EXPECT_EQ(counts.run, newest);
  EXPECT_DOUBLE_EQ(counts.noise.std_m, 12.5e-6);
  EXPECT_EQ(counts.noise.degrees_of_freedom, 9.0);
}

TEST_F(PastQualificationOfAStore, IsTheNumberThatIsWrittenWithTheRunToTheLastBit) {
  ended(Verdict::kAccepted, kEnded, 5.229389348108465);
  const auto counts = found().value();
  const std::string conditions = conditions_document({}, {.qualified = counts});
  EXPECT_EQ(qualified_noise(conditions).value().std_m, counts.noise.std_m);
}

TEST_F(PastQualificationOfAStore, CountsForADayAndNeverBeforeItWasMade) {
  ended(Verdict::kAccepted, kEnded);
  EXPECT_TRUE(found(kDigest, kQualifiedFor));
  EXPECT_FALSE(found(kDigest, kQualifiedFor + 1h));
  EXPECT_FALSE(found(kDigest, -1h)) << "the clock was set back";
}

TEST_F(PastQualificationOfAStore, OfOtherFilesDoesNotCount) {
  ended(Verdict::kAccepted, kEnded);
  EXPECT_FALSE(found("other files"));
  EXPECT_FALSE(found(std::nullopt));
}

TEST_F(PastQualificationOfAStore, ThatDidNotPassHidesTheOnesBeforeIt) {
  ended(Verdict::kAccepted, kEnded);
  ended(Verdict::kRejected, kEnded);
  EXPECT_FALSE(found());
}

TEST_F(PastQualificationOfAStore, ThatCannotBeReadForbidsNothing) {
  const std::int64_t run = ended(Verdict::kAccepted, kEnded);
  store_.database()->exec("UPDATE runs SET recipe = 'another' WHERE id = " + std::to_string(run));
  EXPECT_FALSE(found());
}

}  // namespace
}  // namespace cell
