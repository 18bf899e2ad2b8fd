#pragma once

#include <gmock/gmock.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>
#include <utility>

#include "service/http/routes/route_table.hpp"
#include "service/http/routes/routes.hpp"
#include "service/http/server/target.hpp"
#include "tests/service/document_schema.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {

/// Requests to the routes of a cell without a controller; each answer is held against its schema.
class RoutesTest : public ::testing::Test {
 protected:
  RoutesTest() = default;
  explicit RoutesTest(Cell cell) : cell_(std::move(cell)) {}

  /// The problem document of a refusal; the test fails when it is none.
  static nlohmann::json problem(const HttpResponse& response) {
    EXPECT_EQ(response.content_type, "application/problem+json");
    const nlohmann::json document = nlohmann::json::parse(response.body, nullptr, false);
    EXPECT_TRUE(document.is_object()) << response.body;
    if (!document.is_object()) return nlohmann::json::object();
    EXPECT_EQ(document.value("status", 0u), response.status);
    for (const char* field : {"type", "title", "detail"})
      EXPECT_FALSE(document.value(field, "").empty()) << field << " is missing: " << response.body;
    EXPECT_THAT(document.value("type", ""), ::testing::StartsWith("urn:touchcal:problem:"));
    return document;
  }

  HttpResponse send(const HttpRequest& request) {
    const HttpResponse response = cell_.run(route(request, cell_.operation(), kTokens));
    expect_as_documented(request, response);
    return response;
  }

  HttpResponse get(const std::string& target) {
    HttpRequest request = made("GET", target);
    request.from_loopback = true;
    return send(request);
  }
  HttpResponse post(const std::string& target, const std::string& body = "") {
    HttpRequest request = made("POST", target);
    request.authorization = "Bearer " + kTokens.operate;
    request.content_type = "application/json";
    request.body = body;
    return send(request);
  }
  static HttpRequest made(const std::string& method, const std::string& target) {
    const auto parsed = parse_target(target).value();
    return {.method = method, .path = parsed.first, .query = parsed.second};
  }
  nlohmann::json status() { return nlohmann::json::parse(get("/api/v1/status").body); }

  std::int64_t stored_run(std::optional<std::string> key = std::nullopt) {
    return cell_.store().begin_run(
        {.recipe = "edf-25", .started_at = "start", .idempotency_key = std::move(key)});
  }
  /// The route's path with a run that is there.
  std::string with_run(const Route& name) {
    return std::regex_replace(std::string(name.path), std::regex("\\{id\\}"), std::to_string(stored_run()));
  }
  static std::string path_of(std::int64_t run) { return "/api/v1/runs/" + std::to_string(run); }

  QuietCell cell_;
};

}  // namespace cell
