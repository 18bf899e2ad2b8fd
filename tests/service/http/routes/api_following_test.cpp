// What an Api looks at again and again.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <chrono>
#include <memory>
#include <string>

#include "service/store/model_store.hpp"
#include "tests/service/http/routes/api_bench.hpp"

namespace cell {
namespace {

using ApiFollowingTest = ApiTest;

TEST_F(ApiFollowingTest, WhoReadsWithATokenIsToldAtOnceThatItDoesNotCountAnyMore) {
  HttpRequest request{.method = "GET", .path = "/api/v1/events"};
  request.authorization = "Bearer " + kTokens.operators[0].token;
  const std::unique_ptr<EventSource> events = api_.events(request);
  EXPECT_NE(events->due(), "");
  bool is_woken = false;
  boost::asio::co_spawn(quiet_.context(), events->wait(),
                        [&](const std::exception_ptr&) { is_woken = true; });
  request.path = "/api/v1/status";
  request.query = {{"wait_s", "60"}, {"after", std::to_string(quiet_.operation().sequence())}};
  unsigned status = 0;
  boost::asio::co_spawn(
      quiet_.context(), api_.answer(request),
      [&](const std::exception_ptr&, const HttpResponse& answer) { status = answer.status; });
  quiet_.context().poll();
  ASSERT_FALSE(is_woken);
  ASSERT_EQ(status, 0U);
  Tokens more = kTokens;
  more.operators.push_back({"dora", std::string(64, 'e')});
  api_.take_tokens(more);
  quiet_.context().poll();
  EXPECT_EQ(status, 0U) << "its token counts as before";
  Tokens others = kTokens;
  others.operators.erase(others.operators.begin());
  api_.take_tokens(others);
  quiet_.context().poll();
  EXPECT_TRUE(is_woken);
  EXPECT_EQ(events->due(), "");
  EXPECT_TRUE(events->ended());
  EXPECT_EQ(status, 401U);
}

TEST_F(ApiFollowingTest, TheMetricsOfTheCellAreReadAtOnceAndAgain) {
  const auto serving = quiet_.context().get_executor();
  Api api(serving, {.operation = serving, .store = serving, .reader = serving}, quiet_.operation(), kTokens);
  const auto is_shown = [&](const char* row) {
    return api.services().metrics.text({}, {}).find(std::string("\n") + row + "\n") != std::string::npos;
  };
  const std::int64_t calibration = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  quiet_.store().finish_run(calibration,
                            {.verdict = Verdict::kAccepted, .ended_at = "1970-01-01T00:00:00.000Z"});
  const auto prove = [&](Verdict verdict) {
    const std::int64_t proof = quiet_.store().begin_run(
        {.kind = RunKind::kProof, .of_run = calibration, .recipe = "edf-25", .started_at = "start"});
    quiet_.store().finish_run(proof, {.verdict = verdict, .ended_at = "1970-01-02T00:00:00.000Z"});
  };
  prove(Verdict::kRejected);
  boost::asio::co_spawn(quiet_.context(), api.follow_cell(std::chrono::milliseconds(0)),
                        boost::asio::detached);
  EXPECT_TRUE(is_shown("touchcal_proof_passed Nan"));
  quiet_.context().restart();
  while (!is_shown("touchcal_proof_passed 0")) ASSERT_EQ(quiet_.context().run_one(), 1u);
  prove(Verdict::kAccepted);
  while (!is_shown("touchcal_proof_passed 1")) ASSERT_EQ(quiet_.context().run_one(), 1u);
}

TEST_F(ApiFollowingTest, WhatTheMetricsCannotReadIsLoggedOnce) {
  const auto serving = quiet_.context().get_executor();
  Api api(serving, {.operation = serving, .store = serving, .reader = serving}, quiet_.operation(), kTokens);
  const std::int64_t calibration = quiet_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  quiet_.store().finish_run(calibration, {.verdict = Verdict::kAccepted, .ended_at = "end"});
  ModelStore(quiet_.store().database())
      .approve({.run_id = calibration,
                .at = "1970-01-01T00:00:00.000Z",
                .hash = "hash",
                .document = "no model",
                .arm_json = "{}"});
  boost::asio::co_spawn(quiet_.context(), api.follow_cell(std::chrono::milliseconds(0)),
                        boost::asio::detached);
  quiet_.context().restart();
  ::testing::internal::CaptureStdout();
  for (int step = 0; step < 100; ++step) EXPECT_EQ(quiet_.context().run_one(), 1u) << "it goes on";
  const std::string said = ::testing::internal::GetCapturedStdout();
  const std::size_t first = said.find("metrics of checks and models are left out");
  ASSERT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find("left out", first + 50), std::string::npos) << said;
}

}  // namespace
}  // namespace cell
