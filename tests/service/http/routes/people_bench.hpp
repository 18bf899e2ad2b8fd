#pragma once

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "service/http/routes/route_table.hpp"
#include "tests/service/acquisition/made_up_time.hpp"
#include "tests/service/document_schema.hpp"
#include "tests/service/http/routes/api_bench.hpp"

namespace cell {

/// People at the whole API, with real hashes. Each answer is held against its schema.
class PeopleDeskTest : public ApiTest {
 protected:
  HttpResponse send(const HttpRequest& request) {
    HttpResponse response = ApiTest::send(request);
    expect_as_documented(request, response);
    return response;
  }
  void add(const std::string& name, const std::string& role, const std::string& secret = "271828") {
    const nlohmann::json body{{"name", name}, {"role", role}, {"secret", secret}};
    const HttpResponse response = send(post("/api/v1/users", body.dump()));
    ASSERT_EQ(response.status, 201U) << response.body;
  }
  HttpResponse sign_in_answer(const std::string& name, const std::string& secret,
                              const std::string& remote = "192.0.2.7") {
    HttpRequest request = post("/api/v1/sign-in", nlohmann::json{{"name", name}, {"secret", secret}}.dump());
    request.authorization.reset();
    request.remote = remote;
    return send(request);
  }
  std::string sign_in(const std::string& name, const std::string& secret = "271828") {
    const HttpResponse response = sign_in_answer(name, secret);
    EXPECT_EQ(response.status, 201U) << response.body;
    return nlohmann::json::parse(response.body).value("token", "");
  }
  static HttpRequest by(const std::string& token, HttpRequest request) {
    request.authorization = "Bearer " + token;
    request.from_loopback = false;
    return request;
  }
  static HttpRequest get(const std::string& path) { return {.method = "GET", .path = path}; }
  nlohmann::json session(const std::string& token) {
    const HttpResponse response = send(by(token, get("/api/v1/session")));
    return nlohmann::json::parse(response.body);
  }
  std::string role(const std::string& token) { return session(token).at("role"); }
  unsigned status(const std::string& token, const HttpRequest& request) {
    return send(by(token, request)).status;
  }
};

/// The thread that hashes is stepped by hand, so that others act while a request waits for it.
class SlowHashing : public ::testing::Test {
 protected:
  SlowHashing() {
    add("otto", "operate");
    add("eva", "engineer");
  }
  using Answered = std::shared_ptr<std::optional<HttpResponse>>;

  Answered begin(const std::string& token, const std::string& path, const nlohmann::json& body,
                 const std::string& remote = "192.0.2.7") {
    requests_.push_back({.method = "POST",
                         .path = path,
                         .authorization = "Bearer " + token,
                         .content_type = "application/json",
                         .body = body.dump(),
                         .remote = remote});
    auto answered = std::make_shared<std::optional<HttpResponse>>();
    boost::asio::co_spawn(quiet_.context(), api_.answer(requests_.back()),
                          [answered](const std::exception_ptr& failure, HttpResponse answer) {
                            EXPECT_FALSE(failure);
                            *answered = std::move(answer);
                          });
    settle();
    return answered;
  }
  void settle() {
    quiet_.context().restart();
    quiet_.context().poll();
  }
  void hash_one() {
    hashing_.restart();
    ASSERT_EQ(hashing_.run_one(), 1U) << "nothing waits for it";
    settle();
  }
  void add(const std::string& name, const std::string& role) {
    const Answered added =
        begin(kTokens.operate, "/api/v1/users", {{"name", name}, {"role", role}, {"secret", "271828"}});
    hash_one();
    ASSERT_EQ(status(added), 201U);
  }
  /// An engineer's word, which needs no hash.
  void change_role(const std::string& name, const std::string& role) {
    ASSERT_EQ(status(begin(kTokens.operate, "/api/v1/users", {{"name", name}, {"role", role}})), 201U);
  }
  std::string sign_in(const std::string& name) {
    const Answered signed_in = begin("", "/api/v1/sign-in", {{"name", name}, {"secret", "271828"}});
    hash_one();
    EXPECT_EQ(status(signed_in), 201U);
    return nlohmann::json::parse(answered_text(signed_in)).value("token", "");
  }
  static unsigned status(const Answered& answered) { return *answered ? (*answered)->status : 0; }
  static std::string answered_text(const Answered& answered) { return *answered ? (*answered)->body : "{}"; }
  std::vector<std::string> users() {
    std::vector<std::string> names;
    for (const User& user : api_.services().user_book.users) names.push_back(user.name);
    return names;
  }

  MadeUpTime time_;
  QuietCell quiet_{edf(), time_.clocks().steady};
  boost::asio::io_context hashing_{1};
  std::deque<HttpRequest> requests_;
  Api api_{quiet_.context().get_executor(),
           {.operation = quiet_.context().get_executor(),
            .store = quiet_.context().get_executor(),
            .reader = quiet_.context().get_executor(),
            .worker = hashing_.get_executor()},
           quiet_.operation(),
           kTokens};
};

}  // namespace cell
