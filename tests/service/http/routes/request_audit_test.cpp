#include "service/http/routes/request_audit.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include "service/http/auth/access.hpp"
#include "service/http/routes/route_table.hpp"
#include "service/http/routes/services.hpp"
#include "tests/service/acquisition/made_up_time.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

using ::testing::SizeIs;

/// Refusals of strangers that are recorded when they come at once.
constexpr int kAtOnce = RequestAudit::kStrangersAtOnce;

class RequestAuditTest : public ::testing::Test {
 protected:
  static HttpRequest post(const std::string& path, const std::string& body = "",
                          const std::string& token = kTokens.operate) {
    HttpRequest request{.method = "POST", .path = path, .remote = "127.0.0.1"};
    request.authorization = "Bearer " + token;
    request.content_type = "application/json";
    request.body = body;
    return request;
  }
  /// The row that the outcome of the request leaves, where it is admitted with its body as that of a start.
  AuditEntry recorded(const HttpRequest& request, unsigned status = 202) {
    const auto outcome = admit(request, kTokens);
    const auto* admitted = std::get_if<Admitted>(&outcome);
    audit_.record(request, caller_of(request, kTokens), admitted ? admitted->start.get() : nullptr, status);
    EXPECT_NE(newest().outcome, std::to_string(status)) << "the answer does not wait for it";
    cell_.context().restart();
    cell_.context().run();
    AuditEntry row = newest();
    cell_.store().database()->exec("DELETE FROM audit");
    return row;
  }
  AuditEntry newest() {
    const auto page = services_.audit.page(1);
    return page.empty() ? AuditEntry{} : page.front();
  }
  std::string operator_of(const std::string& path, const std::string& body = "") {
    return recorded(post(path, body)).operator_name;
  }

  MadeUpTime time_;
  QuietCell cell_{edf(), time_.clocks().steady};
  Services services_{cell_.operation(), kTokens};
  RequestAudit audit_{cell_.context().get_executor(), services_};
};

TEST_F(RequestAuditTest, ARowTellsWhoAndWhatAndFromWhere) {
  const AuditEntry row = recorded(post("/api/v1/cell/reset", "", kTokens.operators[0].token), 409);
  EXPECT_EQ(row.at, "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(row.who, "operate");
  EXPECT_EQ(row.token_name, "anna");
  EXPECT_EQ(row.operator_name, "");
  EXPECT_EQ(row.remote, "127.0.0.1");
  EXPECT_EQ(row.action, "POST /api/v1/cell/reset");
  EXPECT_EQ(row.outcome, "409");
  EXPECT_THAT(recorded(post("/" + std::string(9000, 'a'))).action, SizeIs(256));
}

TEST_F(RequestAuditTest, ACommandNamesTheOperatorOfItsRun) {
  const std::int64_t named =
      cell_.store().begin_run({.recipe = "edf-25", .started_at = "start", .operator_name = "M. Curie"});
  const std::int64_t nameless = cell_.store().begin_run({.recipe = "edf-25", .started_at = "start"});
  const std::string of_run = "/api/v1/runs/" + std::to_string(named);
  EXPECT_EQ(operator_of(of_run + "/pause"), "M. Curie");
  EXPECT_EQ(operator_of("/api/v1/runs/" + std::to_string(nameless) + "/pause"), "") << "nobody was named";
  EXPECT_EQ(operator_of("/api/v1/runs/99/pause"), "");
  EXPECT_EQ(operator_of("/api/v1/runs/99999999999999999999/pause"), "");
  EXPECT_EQ(operator_of("/api/v1/runs/x/pause"), "");
  EXPECT_EQ(operator_of("/api/v1/cell/reset"), "");
  cell_.store().database()->exec("ALTER TABLE runs RENAME TO gone");
  EXPECT_EQ(operator_of(of_run + "/abort"), "") << "a command does not fail by it";
}

TEST_F(RequestAuditTest, AStartNamesTheOperatorOfItsBodyHoweverLongThatIs) {
  const std::string start = "/api/v1/runs";
  EXPECT_EQ(operator_of(start, R"({"recipe":"edf-25","operator":"É. du Châtelet"})"), "É. du Châtelet");
  EXPECT_EQ(operator_of(start, R"({"operator":"M. Curie"})" + std::string(10'000, ' ')), "M. Curie");
  for (const char* body : {R"({"recipe":"edf-25","operator":7})", R"({"recipe":"edf-25"})", "[]", "{", ""})
    EXPECT_EQ(operator_of(start, body), "") << body;
}

TEST_F(RequestAuditTest, WhoHasNoOperateTokenNamesNobody) {
  const std::int64_t run =
      cell_.store().begin_run({.recipe = "edf-25", .started_at = "start", .operator_name = "M. Curie"});
  for (const std::string& token : {kTokens.view, std::string(64, 'x')}) {
    const HttpRequest request = post("/api/v1/runs/" + std::to_string(run) + "/abort", "", token);
    EXPECT_EQ(recorded(request, 401).operator_name, "");
  }
}

TEST_F(RequestAuditTest, WhatIsAskedForIsRecordedOrSaidNotToBe) {
  const HttpRequest request = post("/api/v1/cell/reset");
  EXPECT_TRUE(cell_.run(audit_.record_asked(request, caller_of(request, kTokens), nullptr)));
  EXPECT_EQ(newest().outcome, "asked");
  cell_.store().database()->exec("DROP TABLE audit");
  EXPECT_FALSE(cell_.run(audit_.record_asked(request, caller_of(request, kTokens), nullptr)));
}

TEST_F(RequestAuditTest, StrangersThatAreLeftOutAreCounted) {
  const HttpRequest stranger = post("/api/v1/cell/reset", "", std::string(64, 'x'));
  const Caller caller = caller_of(stranger, kTokens);
  for (int i = 0; i < 1000; ++i) audit_.record(stranger, caller, nullptr, 401);
  cell_.context().run();
  EXPECT_THAT(services_.audit.page(1000), SizeIs(kAtOnce));
  EXPECT_EQ(newest().who, "wrong token");
  time_.pass(std::chrono::seconds(1));
  audit_.record(stranger, caller, nullptr, 401);
  cell_.context().restart();
  cell_.context().run();
  EXPECT_EQ(newest().detail, std::to_string(1000 - kAtOnce) + " more before it were not recorded");
}

TEST_F(RequestAuditTest, TheTailOfAFloodIsRecordedOnceItIsAskedFor) {
  HttpRequest stranger = post("/api/v1/cell/reset", "", std::string(64, 'x'));
  const Caller caller = caller_of(stranger, kTokens);
  for (int i = 0; i < 1000; ++i) audit_.record(stranger, caller, nullptr, 401);
  stranger.path = "/api/v1/cell/clear";
  audit_.record(stranger, caller, nullptr, 401);
  cell_.context().run();
  ASSERT_EQ(newest().detail, "");
  for (int i = 0; i < 2; ++i) {
    audit_.record_left_out();
    cell_.context().restart();
    cell_.context().run();
    EXPECT_THAT(services_.audit.page(1000), SizeIs(kAtOnce + 1)) << "once";
  }
  EXPECT_EQ(newest().action, "POST /api/v1/cell/clear") << "the last of them";
  EXPECT_EQ(newest().detail, std::to_string(1000 - kAtOnce) + " more before it were not recorded");
  EXPECT_EQ(newest().who, "wrong token");
}

TEST_F(RequestAuditTest, AnOutcomeThatFindsNoRoomIsDroppedAndTheNextOnesAreRecorded) {
  const HttpRequest request = post("/api/v1/cell/stop");
  const Caller caller = caller_of(request, kTokens);
  for (int i = 0; i < 1100; ++i) audit_.record(request, caller, nullptr, 202);
  cell_.context().run();
  EXPECT_THAT(services_.audit.page(2000), SizeIs(1000));
  EXPECT_EQ(recorded(request, 409).outcome, "409");
}

}  // namespace
}  // namespace cell
