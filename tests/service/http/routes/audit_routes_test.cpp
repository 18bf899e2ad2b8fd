#include "service/documents/audit_document.hpp"
#include "service/store/audit_log.hpp"
#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using ::testing::SizeIs;

class AuditRoutesTest : public RoutesTest {
 protected:
  void write(int count) {
    AuditLog audit(cell_.store().database());
    for (int i = 1; i <= count; ++i)
      audit.append_command({.at = "t",
                            .who = "operate",
                            .token_name = i == 1 ? "anna" : "",
                            .operator_name = i == 1 ? "M. Curie" : "",
                            .remote = "127.0.0.1",
                            .action = "POST /api/v1/runs",
                            .outcome = std::to_string(i)});
  }
  HttpResponse get_with(const std::string& target, const std::string& token) {
    HttpRequest request = made("GET", target);
    request.from_loopback = true;
    if (!token.empty()) request.authorization = "Bearer " + token;
    return send(request);
  }
  AuditDocument page(const std::string& query) {
    return read_audit(get_with("/api/v1/audit" + query, kTokens.operate).body);
  }
};

TEST_F(AuditRoutesTest, PagesLeadThroughAllRowsNewestFirst) {
  write(3);
  const AuditDocument first = page("?limit=2");
  ASSERT_THAT(first.rows, SizeIs(2));
  EXPECT_EQ(first.rows[0].outcome, "3");
  EXPECT_THAT(first.rows[0].hash, SizeIs(64));
  EXPECT_FALSE(first.rows[0].operator_name || first.rows[0].token_name);
  const AuditDocument second = page("?limit=2&before=" + first.next_before.value());
  ASSERT_THAT(second.rows, SizeIs(1));
  EXPECT_EQ(second.rows[0].operator_name, "M. Curie");
  EXPECT_EQ(second.rows[0].token_name, "anna");
  EXPECT_FALSE(second.next_before);
  EXPECT_FALSE(page("?limit=3").next_before);
  EXPECT_THAT(page("").rows, SizeIs(3));
  for (const char* query : {"limit=0", "limit=501", "before=-1", "before=x", "after=1"}) {
    const HttpResponse refused = get_with(std::string("/api/v1/audit?") + query, kTokens.operate);
    EXPECT_EQ(problem(refused).at("status"), 400) << query;
  }
}

TEST_F(AuditRoutesTest, ItIsReadWithTheOperateTokenOnlyAlsoOnLoopback) {
  EXPECT_EQ(get_with("/api/v1/audit", "").status, 401u);
  EXPECT_EQ(get_with("/api/v1/audit", kTokens.view).status, 403u);
  EXPECT_EQ(get_with("/api/v1/audit", kTokens.operate).status, 200u);
  EXPECT_EQ(get_with("/api/v1/audit", kTokens.operators[1].token).status, 200u);
}

}  // namespace
}  // namespace cell
