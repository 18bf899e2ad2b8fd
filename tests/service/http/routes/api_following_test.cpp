// What an Api looks at again and again.
#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <memory>

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

}  // namespace
}  // namespace cell
