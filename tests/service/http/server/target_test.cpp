// A request's target, from the request line to the route.
#include "service/http/server/target.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "service/http/routes/route_table.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

HttpResponse get(const std::string& target) {
  QuietCell cell;
  const auto parsed = parse_target(target).value();
  return cell.run(
      route({.method = "GET", .path = parsed.first, .query = parsed.second, .from_loopback = true},
            cell.operation(), kTokens));
}

TEST(ParseTarget, TakesPathAndQueryApart) {
  const auto parsed = parse_target("/a/b?x=1&y=&z&x=2&&w=a=b");
  ASSERT_TRUE(parsed);
  EXPECT_EQ(parsed->first, "/a/b");
  EXPECT_EQ(parsed->second, (Query{{"", ""}, {"w", "a=b"}, {"x", "1"}, {"x", "2"}, {"y", ""}, {"z", ""}}));
  EXPECT_EQ(parse_target("/")->second.size(), 0u);
  for (const char* target : {"", "*", "http://127.0.0.1/api/v1/status", "127.0.0.1:80", "?x=1"})
    EXPECT_FALSE(parse_target(target)) << target;
}

TEST(ParseTarget, TheLastPairMayEndInAnAmpersand) {
  EXPECT_EQ(parse_target("/?")->second, Query());
  EXPECT_EQ(parse_target("/?x=1&")->second, (Query{{"x", "1"}}));
  EXPECT_EQ(parse_target("/?&&")->second, (Query{{"", ""}, {"", ""}}));
}

TEST(ParseTarget, NamesAndValuesOfTheQueryArePercentDecodedOnce) {
  EXPECT_EQ(parse_target("/?recipe=edf%2D25")->second, (Query{{"recipe", "edf-25"}}));
  EXPECT_EQ(parse_target("/?wait_s=%32&%61fter=7")->second, (Query{{"after", "7"}, {"wait_s", "2"}}));
  EXPECT_EQ(parse_target("/?x=%26y%3D%3f%2523")->second, (Query{{"x", "&y=?%23"}}));
  EXPECT_EQ(parse_target("/?x=a+b%20c%2b")->second, (Query{{"x", "a+b c+"}})) << "a plus sign stays one";
  EXPECT_EQ(parse_target("/?x=%C3%A9")->second, (Query{{"x", "\xc3\xa9"}}));
}

TEST(ParseTarget, ThePathStaysEncodedSoThatAnEncodedSlashDoesNotSplitASegment) {
  for (const char* path : {"/api/v1/runs/a%2fb", "/a%252Fb/c%25", "//a/../b/", "/%61//b/"})
    EXPECT_EQ(parse_target(path + std::string("?x"))->first, path);
}

TEST(DecodeSegment, DecodesOnce) {
  EXPECT_EQ(decode_segment("a%2Fb%2d+"), "a/b-+");
  EXPECT_EQ(decode_segment("a%252Fb"), "a%2Fb");
}

TEST(ParseTarget, WhatIsMalformedIsRefused) {
  for (const char* part : {"%", "%4", "%zz", "%-1", "a b", "#x", "[", "]",        "{",    "}",
                           "|", "\\", "^",   "<",   ">",   "\"", "`", "\xc3\xa9", "\x7f", "\t"}) {
    EXPECT_FALSE(parse_target(std::string("/a") + part)) << part;
    EXPECT_FALSE(parse_target(std::string("/a?x=") + part)) << part;
    EXPECT_FALSE(parse_target(std::string("/a?") + part + "=1")) << part;
  }
}

TEST(ParseTarget, NulAndControlCharactersAreRefusedAlsoPercentEncoded) {
  for (const char* part : {"%00", "%0a", "%0D", "%1b", "%1F", "%7f"}) {
    EXPECT_FALSE(parse_target(std::string("/a") + part)) << part;
    EXPECT_FALSE(parse_target(std::string("/a?x=b") + part)) << part;
    EXPECT_FALSE(parse_target(std::string("/a?b") + part + "=1")) << part;
  }
  EXPECT_FALSE(parse_target(std::string_view("/a\0b", 4)));
}

TEST(Target, APercentEncodedQueryIsTakenForWhatItMeans) {
  EXPECT_EQ(get("/api/v1/runs?limit=%32&%6Cimit=%33").status, 400u) << "given twice";
  EXPECT_EQ(get("/api/v1/runs?li%6Dit=%32").status, 200u);
  EXPECT_EQ(get("/api/v1/status?wait_s=%30").status, 200u);
}

TEST(Target, AnIdIsDecodedOnceAndAnEncodedSlashBelongsToIt) {
  const auto detail = [](const std::string& target) {
    const HttpResponse response = get(target);
    EXPECT_EQ(response.status, 404u) << target;
    return json::parse(response.body).at("detail").get<std::string>();
  };
  EXPECT_THAT(detail("/api/v1/runs/%78"), HasSubstr("there is no run 'x'"));
  EXPECT_THAT(detail("/api/v1/runs/1%2Ftouches"), HasSubstr("there is no run '1/touches'"));
  EXPECT_THAT(detail("/api/v1/runs/1%252F2"), HasSubstr("there is no run '1%2F2'"));
  EXPECT_THAT(detail("/api/v1%2Fstatus"), HasSubstr("there is nothing at /api/v1%2Fstatus"));
}

}  // namespace
}  // namespace cell
