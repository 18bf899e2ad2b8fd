#include "service/archive/archive_reader.hpp"

#include <gmock/gmock.h>

#include "service/store/fault_log.hpp"
#include "service/store/model_store.hpp"
#include "tests/service/archive/archive_bench.hpp"

namespace cell {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST_F(ArchiveTest, VerifyTellsWhatWasChangedOrIsMissing) {
  run_of(store_);
  run_of(store_);
  connect()->deliver(facts(), {});
  const auto damage_after = [&](const std::string& tampering) {
    EXPECT_EQ(sql(tampering), 1u) << tampering;
    return look_at_archive(owner_).damage;
  };
  EXPECT_THAT(damage_after("UPDATE event SET at = '2025-01-01' WHERE seq = 2"),
              ElementsAre("cell edf, event 2: it was changed"));
  EXPECT_THAT(damage_after("DELETE FROM event WHERE seq = 2"),
              ElementsAre("cell edf: events 2 to 2 are missing"));
  EXPECT_THAT(damage_after("UPDATE event SET seq = 2 WHERE seq = 3"),
              ::testing::Contains("cell edf, event 2: the event before is another one"));
  sql("DELETE FROM event");
  connect()->deliver(facts(), {});
  EXPECT_THAT(damage_after("DELETE FROM document WHERE body LIKE '%b%'"),
              ElementsAre("cell edf, event 2: the document of its arm_sha256 is not there",
                          "cell edf, event 5: the document of its arm_sha256 is not there"));
}

TEST_F(ArchiveTest, TheHistoryOfACellIsWhatItToldNewestFirst) {
  run_of(store_);
  connect()->deliver(facts(), {});
  const std::vector<Fact> told = facts();
  const HistoryDocument all = history_of(owner_, "edf", 10);
  ASSERT_EQ(all.facts.size(), told.size());
  for (std::size_t i = 0; i < told.size(); ++i) {
    const ArchivedFact& archived = all.facts[told.size() - 1 - i];
    EXPECT_EQ(archived.seq, told[i].seq);
    EXPECT_EQ(archived.kind, told[i].kind);
    EXPECT_EQ(archived.at, told[i].at);
    EXPECT_EQ(archived.body.text, told[i].body);
  }
  EXPECT_EQ(all.next_before, std::nullopt);
  const HistoryDocument newest = history_of(owner_, "edf", 2);
  EXPECT_EQ(newest.next_before, newest.facts.back().seq);
  const HistoryDocument older = history_of(owner_, "edf", 2, newest.next_before);
  EXPECT_EQ(older.facts.size(), told.size() - 2);
  EXPECT_EQ(older.next_before, std::nullopt);
  EXPECT_THAT(history_of(owner_, "another", 2).facts, IsEmpty());
}

}  // namespace
}  // namespace cell
