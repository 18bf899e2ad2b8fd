#pragma once

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "service/http/routes/api.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {

/// Requests to the API of a cell without a controller, all on one thread.
class ApiTest : public ::testing::Test {
 protected:
  static HttpRequest post(const std::string& path, const std::string& body = "") {
    return {.method = "POST",
            .path = path,
            .authorization = "Bearer " + kTokens.operate,
            .content_type = "application/json",
            .body = body,
            .from_loopback = true,
            .remote = "127.0.0.1"};
  }
  static HttpRequest keyed(const std::string& path, const std::string& key, const std::string& body = "") {
    HttpRequest request = post(path, body);
    request.idempotency_key = key;
    return request;
  }

  HttpResponse send(const HttpRequest& request) {
    std::optional<HttpResponse> response;
    boost::asio::co_spawn(quiet_.context(), api_.answer(request),
                          [&](const std::exception_ptr& failure, HttpResponse answer) {
                            EXPECT_FALSE(failure);
                            response = std::move(answer);
                          });
    quiet_.context().restart();
    quiet_.context().run();
    return response.value_or(HttpResponse{.status = 0});
  }
  AuditEntry last_audit() {
    const auto page = api_.services().audit.page(1);
    return page.empty() ? AuditEntry{} : page.front();
  }
  std::string metrics() { return send({.method = "GET", .path = "/metrics", .from_loopback = true}).body; }
  std::string state() {
    return nlohmann::json::parse(
               send({.method = "GET", .path = "/api/v1/status", .from_loopback = true}).body)
        .at("state");
  }

  QuietCell quiet_;
  Api api_{quiet_.context().get_executor(), quiet_.operation(), kTokens};
};

}  // namespace cell
