// Faults, audit and answers, which share the file of runs and touches.
#include <gmock/gmock.h>

#include "service/base/digest.hpp"
#include "service/store/answer_store.hpp"
#include "service/store/audit_log.hpp"
#include "service/store/fault_log.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

class StoreLogs : public ::testing::Test {
 protected:
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  TouchStore store_{file_};
};

TEST_F(StoreLogs, FaultsComeBackNewestFirstAndByRun) {
  const std::int64_t run = store_.begin_run({.recipe = "edf-25", .started_at = "start"});
  FaultLog faults(store_.database());
  faults.append(std::nullopt, "t1", "controller_unreachable", "refused");
  faults.append(run, "t2", "no_contact", "the search ended");
  const auto all = faults.page(10);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].code, "no_contact");
  EXPECT_EQ(all[0].run_id, run);
  EXPECT_EQ(all[1].message, "refused");
  EXPECT_FALSE(all[1].run_id);
  EXPECT_EQ(faults.page(10, all[0].id).size(), 1u);
  EXPECT_EQ(faults.page(10, {}, run).size(), 1u);
  EXPECT_EQ(FaultLog(open_database(file_)).page(10).size(), 2u);
}

TEST_F(StoreLogs, TheAuditIsReadInPages) {
  AuditLog audit(store_.database());
  for (const std::string at : {"t1", "t2", "t3"}) {
    audit.append_command({.at = at,
                          .who = "operate",
                          .remote = "127.0.0.1",
                          .action = "POST /api/v1/runs",
                          .outcome = "201",
                          .detail = "run 1"});
  }
  audit.append_refusal({.at = "t4", .who = "none", .outcome = "401 token"});
  const auto first = audit.page(2);
  ASSERT_EQ(first.size(), 2u);
  EXPECT_EQ(first[0].outcome, "401 token");
  EXPECT_EQ(first[1].at, "t3");
  const auto second = audit.page(10, first[1].id);
  ASSERT_EQ(second.size(), 2u);
  EXPECT_EQ(second[1].at, "t1");
  EXPECT_EQ(second[1].who, "operate");
  EXPECT_EQ(second[1].action, "POST /api/v1/runs");
  EXPECT_EQ(second[1].detail, "run 1");
}

TEST_F(StoreLogs, ARepeatedKeyGetsTheFirstAnswerAlsoAfterARestart) {
  const KeyedRequest request{"key", "POST /api/v1/runs", sha256_hex("{}")};
  const StoredAnswer answer{201, {{"Location", "/api/v1/runs/1"}}, std::string("{\"a\":\0}", 7)};
  AnswerStore answers(store_.database());
  EXPECT_TRUE(std::holds_alternative<KeyIsNew>(answers.take(request, "t0")));
  EXPECT_TRUE(std::holds_alternative<KeyInProgress>(answers.take(request, "t0")));
  answers.keep(request, answer, "t1");
  AnswerStore restarted(open_database(file_));
  for (AnswerStore* each : {&answers, &restarted}) {
    const KeyLookUp found = each->take(request, "t0");
    ASSERT_TRUE(std::holds_alternative<StoredAnswer>(found));
    EXPECT_EQ(std::get<StoredAnswer>(found).status, 201u);
    EXPECT_EQ(std::get<StoredAnswer>(found).headers, answer.headers);
    EXPECT_EQ(std::get<StoredAnswer>(found).body, answer.body);
  }
}

TEST_F(StoreLogs, AKeyOfAnotherRequestOrBodyIsTold) {
  const KeyedRequest request{"key", "POST /api/v1/runs", sha256_hex("a")};
  AnswerStore answers(store_.database());
  answers.take(request, "t0");
  answers.keep(request, {.status = 201}, "t1");
  EXPECT_TRUE(std::holds_alternative<KeyOfAnother>(
      answers.take({"key", "POST /api/v1/plan", request.body_digest}, "t0")));
  EXPECT_TRUE(
      std::holds_alternative<KeyOfAnother>(answers.take({"key", request.request, sha256_hex("b")}, "t0")));
}

TEST_F(StoreLogs, AKeyIsFreeAgainAfterItsTimeOrWithoutAnAnswer) {
  const KeyedRequest request{"key", "POST /api/v1/runs", ""};
  AnswerStore answers(store_.database());
  answers.take(request, "t0");
  answers.give_up(request);
  EXPECT_TRUE(std::holds_alternative<KeyIsNew>(answers.take(request, "t0")));
  answers.keep(request, {.status = 201}, "t1");
  EXPECT_TRUE(std::holds_alternative<KeyIsNew>(answers.take(request, "t2")));
}

TEST(Digest, IsThatOfTheStandard) {  // FIPS 180-4, the example "abc"
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace cell
