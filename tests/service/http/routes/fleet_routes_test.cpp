#include <stdexcept>

#include "service/documents/fleet_document.hpp"
#include "service/http/server/target.hpp"
#include "tests/service/document_schema.hpp"
#include "tests/service/http/routes/api_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

class FleetRoutesTest : public ApiTest {
 protected:
  HttpResponse get(const std::string& path, const std::string& query = "") {
    const auto target = parse_target(path + (query.empty() ? "" : "?" + query)).value();
    const HttpRequest request{
        .method = "GET", .path = target.first, .query = target.second, .from_loopback = true};
    const HttpResponse response = send(request);
    expect_as_documented(request, response);
    return response;
  }
  FleetView& fleet() { return api_.services().fleet; }
};

TEST_F(FleetRoutesTest, WithoutAnArchiveThereIsNone) {
  for (const char* path : {"/api/v1/fleet", "/api/v1/fleet/trends"}) {
    const HttpResponse response = get(path);
    EXPECT_EQ(response.status, 409u) << path;
    EXPECT_THAT(response.body, HasSubstr("urn:touchcal:problem:no-archive"));
    EXPECT_THAT(response.body, HasSubstr("touchcald --archive URL"));
  }
}

TEST_F(FleetRoutesTest, TellWhatTheArchiveSays) {
  const std::string cells = document_text(FleetDocument{.cells = {{.cell = "a", .last_event_at = "then"}}});
  int months_asked = 0;
  fleet() = {.cells = [&] { return cells; },
             .trends =
                 [&](int months) {
                   months_asked = months;
                   return document_text(FleetTrendsDocument{.trends = {{.month = "2026-11"}}});
                 }};
  EXPECT_EQ(get("/api/v1/fleet").body, cells);
  EXPECT_THAT(get("/api/v1/fleet/trends").body, HasSubstr("2026-11"));
  EXPECT_EQ(months_asked, 12);
  (void)get("/api/v1/fleet/trends", "months=240");
  EXPECT_EQ(months_asked, 240);
  for (const char* months : {"months=0", "months=241", "months=x"})
    EXPECT_EQ(get("/api/v1/fleet/trends", months).status, 400u) << months;
}

TEST_F(FleetRoutesTest, AnArchiveThatIsAwayIsSaidToBe) {
  fleet().cells = []() -> std::string { throw std::runtime_error("the archive cannot be read: it is away"); };
  const HttpResponse response = get("/api/v1/fleet");
  EXPECT_EQ(response.status, 503u);
  EXPECT_EQ(json::parse(response.body).at("detail"), "the archive cannot be read: it is away");
  EXPECT_THAT(response.headers, ::testing::Contains(::testing::Key("Retry-After")));
}

}  // namespace
}  // namespace cell
