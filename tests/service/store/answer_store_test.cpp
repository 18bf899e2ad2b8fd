#include "service/store/answer_store.hpp"

#include <gmock/gmock.h>

#include "service/base/digest.hpp"
#include "service/store/run_store.hpp"
#include "tests/config/folder.hpp"

namespace cell {
namespace {

class AnswerStoreTest : public ::testing::Test {
 protected:
  Folder folder_;
  std::filesystem::path file_ = folder_.path() / "touchcal.sqlite";
  RunStore store_{file_};
};

TEST_F(AnswerStoreTest, ARepeatedKeyGetsTheFirstAnswerAlsoAfterARestart) {
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

TEST_F(AnswerStoreTest, AKeyOfAnotherRequestOrBodyIsTold) {
  const KeyedRequest request{"key", "POST /api/v1/runs", sha256_hex("a")};
  AnswerStore answers(store_.database());
  answers.take(request, "t0");
  answers.keep(request, {.status = 201}, "t1");
  EXPECT_TRUE(std::holds_alternative<KeyReused>(
      answers.take({"key", "POST /api/v1/plan", request.body_digest}, "t0")));
  EXPECT_TRUE(
      std::holds_alternative<KeyReused>(answers.take({"key", request.request, sha256_hex("b")}, "t0")));
}

TEST_F(AnswerStoreTest, AKeyIsFreeAgainAfterItsTimeOrWithoutAnAnswer) {
  const KeyedRequest request{"key", "POST /api/v1/runs", ""};
  AnswerStore answers(store_.database());
  answers.take(request, "t0");
  answers.give_up(request);
  EXPECT_TRUE(std::holds_alternative<KeyIsNew>(answers.take(request, "t0")));
  answers.keep(request, {.status = 201}, "t1");
  EXPECT_TRUE(std::holds_alternative<KeyIsNew>(answers.take(request, "t2")));
}

}  // namespace
}  // namespace cell
