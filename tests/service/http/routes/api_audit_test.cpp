// What the API writes into the audit log.
#include <boost/asio/co_spawn.hpp>

#include "tests/service/http/routes/api_bench.hpp"

namespace cell {
namespace {

TEST_F(ApiTest, EveryCommandIsWrittenDownWithWhatCameOfIt) {
  send(post("/api/v1/cell/reset"));
  const auto page = api_.services().audit.page(10);
  ASSERT_EQ(page.size(), 2u);
  EXPECT_EQ(page[1].outcome, "asked") << "before it is taken";
  EXPECT_EQ(page[0].outcome, "202");
  for (const AuditEntry& entry : page) {
    EXPECT_EQ(entry.action, "POST /api/v1/cell/reset");
    EXPECT_EQ(entry.who, "operate");
    EXPECT_EQ(entry.remote, "127.0.0.1");
  }
  send(post("/api/v1/cell/clear"));
  EXPECT_EQ(last_audit().outcome, "409");
}

TEST_F(ApiTest, TheAuditTellsWhoseTokenACommandCameWith) {
  HttpRequest request = post("/api/v1/cell/reset");
  const auto newest = [&](const std::string& token, unsigned status) {
    request.authorization = "Bearer " + token;
    EXPECT_EQ(send(request).status, status);
    return last_audit();
  };
  for (const NamedToken& named : kTokens.operators) {
    request.path = "/api/v1/cell/reset";
    const AuditEntry taken = newest(named.token, 202);
    EXPECT_EQ(taken.token_name, named.name);
    EXPECT_EQ(taken.who, "operate");
    EXPECT_EQ(api_.services().audit.page(2).at(1).token_name, named.name) << "also before it is taken";
    request.path = "/api/v1/cell/clear";
    EXPECT_EQ(newest(named.token, 409).token_name, named.name) << "also of a refusal";
    request.path = "/api/v1/cell/stop";
    EXPECT_EQ(newest(named.token, 202).token_name, named.name) << "also of a stop";
  }
  EXPECT_EQ(newest(kTokens.operate, 202).token_name, "");
  EXPECT_EQ(newest(kTokens.view, 403).token_name, "");
  EXPECT_EQ(newest(std::string(64, 'x'), 401).token_name, "");
}

TEST_F(ApiTest, TheAuditTellsWhoseTokenItWasAlsoWhereItIsReplacedMeanwhile) {
  HttpRequest request = post("/api/v1/cell/reset");
  request.authorization = "Bearer " + kTokens.operators[0].token;
  for (const char* command : {"/api/v1/cell/reset", "/api/v1/cell/stop"}) {
    request.path = command;
    api_.take_tokens(kTokens);
    const std::size_t before = api_.services().audit.page(100).size();
    unsigned status = 0;
    boost::asio::co_spawn(
        quiet_.context(), api_.answer(request),
        [&](const std::exception_ptr&, const HttpResponse& answer) { status = answer.status; });
    quiet_.context().restart();
    quiet_.context().run_one();  // admitted
    ASSERT_EQ(status, 0u);
    api_.take_tokens({});
    quiet_.context().run();
    EXPECT_EQ(status, 202u);
    const auto rows = api_.services().audit.page(100);
    ASSERT_GT(rows.size(), before);
    for (std::size_t i = 0; i < rows.size() - before; ++i) {
      EXPECT_EQ(rows[i].token_name, kTokens.operators[0].name) << rows[i].action << ' ' << rows[i].outcome;
      EXPECT_EQ(rows[i].who, "operate");
    }
  }
}

TEST_F(ApiTest, WhatHaltsIsWrittenDownOnceItIsExecuted) {
  const std::int64_t run =
      quiet_.store().begin_run({.recipe = "edf-25", .started_at = "then", .operator_name = "M. Curie"});
  for (const char* halt : {"/abort", "/pause"}) {
    const std::size_t before = api_.services().audit.page(100).size();
    send(post("/api/v1/runs/" + std::to_string(run) + halt));
    EXPECT_EQ(api_.services().audit.page(100).size(), before + 1) << halt;
    EXPECT_EQ(last_audit().outcome, "409");
    EXPECT_EQ(last_audit().operator_name, "M. Curie");
  }
  HttpRequest stranger = post("/api/v1/runs/" + std::to_string(run) + "/abort");
  stranger.authorization.reset();
  send(stranger);
  EXPECT_EQ(last_audit().operator_name, "") << "it is for a name that a token is needed";
}

TEST_F(ApiTest, EveryRefusalOfACommandIsWrittenDown) {
  HttpRequest request = post("/api/v1/cell/reset");
  request.authorization = "Bearer " + kTokens.view;
  EXPECT_EQ(send(request).status, 403u);
  EXPECT_EQ(last_audit().who, "view");
  EXPECT_EQ(last_audit().outcome, "403");
  request.authorization.reset();
  EXPECT_EQ(send(request).status, 401u);
  EXPECT_EQ(last_audit().who, "none");
  request.authorization = "Bearer " + std::string(64, 'x');
  EXPECT_EQ(send(request).status, 401u);
  EXPECT_EQ(last_audit().who, "wrong token");
  api_.refuse({.status = 403, .kind = ProblemKind::kOrigin, .detail = "a page elsewhere"}, request);
  quiet_.context().restart();
  quiet_.context().run();
  EXPECT_EQ(last_audit().outcome, "403");
  const std::int64_t before = last_audit().id;
  EXPECT_EQ(send({.method = "GET", .path = "/nothing", .from_loopback = true}).status, 404u);
  EXPECT_EQ(last_audit().id, before) << "reading is no command";
}

TEST_F(ApiTest, AFloodOfStrangersDisplacesNoCommandFromTheAudit) {
  send(post("/api/v1/cell/reset"));
  HttpRequest stranger = post("/api/v1/cell/reset");
  stranger.authorization.reset();
  for (int i = 0; i < 500; ++i) EXPECT_EQ(send(stranger).status, 401u);
  const auto all = api_.services().audit.page(1000);
  EXPECT_LT(all.size(), 100u);
  EXPECT_EQ(all[all.size() - 2].outcome, "202") << "what came of the command";
}

}  // namespace
}  // namespace cell
