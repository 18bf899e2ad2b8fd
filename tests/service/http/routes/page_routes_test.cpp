// The operator's page as the daemon gives it.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "service/http/routes/route_table.hpp"
#include "service/http/server/response_text.hpp"
#include "service/page/assets.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::Not;
using ::testing::Pair;

class PageRoutesTest : public ::testing::Test {
 protected:
  /// As a browser elsewhere asks that has no token yet.
  HttpResponse get(const std::string& path, const std::optional<std::string>& known = {}) {
    return cell_.run(route({.method = "GET", .path = path, .if_none_match = known}, cell_.operation(),
                           Tokens{std::string(64, 'a'), std::string(64, 'b')}));
  }

  QuietCell cell_;
};

TEST_F(PageRoutesTest, ThePageAsksNobodyElseAndRunsNoInlineScript) {
  const HttpResponse page = get("/");
  ASSERT_EQ(page.status, 200u);
  EXPECT_THAT(page.body, Not(HasSubstr("://")));
  EXPECT_FALSE(std::regex_search(page.body, std::regex("<script[^>]*>[^<]|style=|<style| on[a-z]+=")));
  const std::string text = response_text(page, 1, true, false);
  EXPECT_THAT(text,
              HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; "
                        "connect-src 'self'; img-src 'self' data:; base-uri 'none'; frame-ancestors 'none'; "
                        "form-action 'none'\r\n"));
  EXPECT_EQ(text.find("Content-Security-Policy"), text.rfind("Content-Security-Policy"));
  EXPECT_THAT(text, HasSubstr("X-Content-Type-Options: nosniff\r\n"));
  EXPECT_THAT(text, HasSubstr("Referrer-Policy: no-referrer\r\n"));
  EXPECT_THAT(text, HasSubstr("Cache-Control: no-cache\r\n"));
}

TEST_F(PageRoutesTest, EverythingThatThePageLoadsIsThereAndMayBeKeptForEver) {
  const std::string page = get("/").body;
  const std::regex loaded("(?:src|href)=\"(/assets/[^\"]+)\"");
  int seen = 0;
  for (std::sregex_iterator found(page.begin(), page.end(), loaded), end; found != end; ++found, ++seen) {
    const HttpResponse asset = get((*found)[1]);
    EXPECT_EQ(asset.status, 200u) << (*found)[1];
    EXPECT_THAT(asset.headers, Contains(Pair("Cache-Control", HasSubstr("immutable"))));
    EXPECT_THAT(asset.headers, Contains(Pair("Content-Encoding", "gzip")));
    EXPECT_EQ(asset.body.substr(0, 2), "\x1f\x8b") << "no gzip";
  }
  EXPECT_GE(seen, 2) << "script and style, and what the script imports at once";
  EXPECT_GT(page_assets().size(), static_cast<std::size_t>(seen) + 1)
      << "the view in three dimensions is loaded on demand";
}

TEST_F(PageRoutesTest, WhatABrowserHasIsNotSentAgain) {
  for (const PageAsset& asset : page_assets()) {
    const std::string path = asset.name.empty() ? "/" : "/assets/" + std::string(asset.name);
    const HttpResponse same = get(path, std::string(asset.etag));
    EXPECT_EQ(same.status, 304u) << path;
    EXPECT_TRUE(same.body.empty());
    EXPECT_EQ(get(path, "\"other\"").status, 200u) << path;
  }
}

TEST_F(PageRoutesTest, APartThatIsNotThereIsNotFound) {
  for (const char* path : {"/assets/", "/assets/main.js", "/assets/..", "/index.html", "/assets"}) {
    const HttpResponse response = get(path);
    EXPECT_EQ(response.status, 404u) << path;
    EXPECT_THAT(response.headers, Not(Contains(Key("Content-Encoding"))));
  }
}

TEST_F(PageRoutesTest, TheFirstLoadIsSmall) {
  constexpr std::size_t kFirstLoadMax = 80'000;
  constexpr std::size_t kWithTheViewMax = 200'000;
  std::size_t first = 0, all = 0;
  const std::string page = get("/").body;
  for (const PageAsset& asset : page_assets()) {
    all += asset.bytes.size();
    if (page.find(asset.name) != page.npos) first += asset.bytes.size();
  }
  EXPECT_LE(first, kFirstLoadMax);
  EXPECT_LE(all, kWithTheViewMax);
}

}  // namespace
}  // namespace cell
