// Signing in and out, and who may: through the whole API, with real hashes.
#include "service/http/routes/internal/people_desk.hpp"

#include <gmock/gmock.h>

#include <boost/asio/io_context.hpp>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>

#include "service/http/routes/route_table.hpp"
#include "tests/service/document_schema.hpp"
#include "tests/service/http/routes/api_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class PeopleDeskTest : public ApiTest {
 protected:
  HttpResponse send(const HttpRequest& request) {
    HttpResponse response = ApiTest::send(request);
    expect_as_documented(request, response);
    return response;
  }
  void add(const std::string& name, const std::string& role, const std::string& secret = "123456") {
    const json body{{"name", name}, {"role", role}, {"secret", secret}};
    const HttpResponse response = send(post("/api/v1/users", body.dump()));
    ASSERT_EQ(response.status, 201U) << response.body;
  }
  HttpResponse sign_in_answer(const std::string& name, const std::string& secret,
                              const std::string& remote = "192.0.2.7") {
    HttpRequest request = post("/api/v1/sign-in", json{{"name", name}, {"secret", secret}}.dump());
    request.authorization.reset();
    request.remote = remote;
    return send(request);
  }
  std::string sign_in(const std::string& name, const std::string& secret = "123456") {
    const HttpResponse response = sign_in_answer(name, secret);
    EXPECT_EQ(response.status, 201U) << response.body;
    return json::parse(response.body).value("token", "");
  }
  static HttpRequest by(const std::string& token, HttpRequest request) {
    request.authorization = "Bearer " + token;
    request.from_loopback = false;
    return request;
  }
  static HttpRequest get(const std::string& path) { return {.method = "GET", .path = path}; }
  json session(const std::string& token) {
    const HttpResponse response = send(by(token, get("/api/v1/session")));
    return json::parse(response.body);
  }
  std::string role(const std::string& token) { return session(token).at("role"); }
  unsigned status(const std::string& token, const HttpRequest& request) {
    return send(by(token, request)).status;
  }
};

TEST_F(PeopleDeskTest, WhoSignsInMayWhatTheirRoleMay) {
  EXPECT_FALSE(session("").at("sign_in"));
  add("vera", "view");
  add("otto", "operate");
  add("eva", "engineer");
  EXPECT_TRUE(session("").at("sign_in"));
  const std::string vera = sign_in("vera"), otto = sign_in("otto"), eva = sign_in("eva");
  const json told = session(otto);
  EXPECT_EQ(told.at("name"), "otto");
  EXPECT_EQ(told.at("role"), "operate");
  EXPECT_EQ(told.at("kind"), "user");
  EXPECT_EQ(told.at("ends_at"), "1970-01-01T10:00:00.000Z") << "ten hours after the cell's clock";

  EXPECT_EQ(status(vera, get("/api/v1/status")), 200U);
  EXPECT_EQ(status(vera, post("/api/v1/cell/acknowledge")), 403U);
  EXPECT_EQ(status(vera, post("/api/v1/cell/stop")), 202U) << "anybody may stop";
  EXPECT_EQ(status(otto, post("/api/v1/cell/acknowledge")), 202U);
  EXPECT_EQ(status(otto, post("/api/v1/models/rollback")), 403U);
  EXPECT_EQ(status(otto, get("/api/v1/users")), 403U);
  EXPECT_EQ(status(eva, post("/api/v1/models/rollback")), 409U) << "there is none: it was allowed";
  EXPECT_EQ(status(eva, get("/api/v1/users")), 200U);
}

TEST_F(PeopleDeskTest, ATokenOfAFileDoesAllAndSaysWhatItIs) {
  const json told = session(kTokens.operate);
  EXPECT_EQ(told.at("kind"), "token");
  EXPECT_EQ(told.at("role"), "engineer");
  EXPECT_EQ(told.at("name"), nullptr);
  EXPECT_EQ(session(kTokens.operators.front().token).at("name"), kTokens.operators.front().name);
  EXPECT_EQ(role(kTokens.view), "view");
  EXPECT_EQ(session(std::string(64, '9')).at("kind"), "none");
}

TEST_F(PeopleDeskTest, TheAuditHasTheirNameAndNoSecret) {
  add("otto", "operate");
  const std::string otto = sign_in("otto");
  AuditEntry row = last_audit();
  EXPECT_EQ(row.action, "POST /api/v1/sign-in");
  EXPECT_EQ(row.who, "operate");
  EXPECT_EQ(row.token_name, "otto");
  EXPECT_EQ(row.outcome, "201");
  sign_in_answer("otto", "654321");
  row = last_audit();
  EXPECT_EQ(row.who, "wrong token");
  EXPECT_EQ(row.token_name, "otto");
  EXPECT_EQ(row.outcome, "401");
  sign_in_answer("123456", "otto");
  EXPECT_EQ(last_audit().token_name, "") << "a name that nobody has may be a secret in the wrong field";
  send(by(otto, post("/api/v1/cell/acknowledge")));
  EXPECT_EQ(last_audit().token_name, "otto");
  for (const AuditEntry& entry : api_.services().audit.page(100)) {
    EXPECT_EQ(entry.detail.find("123456"), std::string::npos);
    EXPECT_EQ(entry.token_name.find("123456"), std::string::npos);
  }
}

TEST_F(PeopleDeskTest, AWrongSecretAndAWrongNameAreRefusedAlike) {
  add("otto", "operate");
  const HttpResponse secret = sign_in_answer("otto", "654321"), name = sign_in_answer("nobody", "123456");
  EXPECT_EQ(secret.status, 401U);
  EXPECT_EQ(secret.body, name.body);
  EXPECT_THAT(secret.body, HasSubstr("urn:touchcal:problem:sign-in"));
}

TEST_F(PeopleDeskTest, TenWrongOnesSlowOneNameOfOneNetworkAndKeepNobodyFromStop) {
  add("otto", "operate");
  add("eva", "engineer");
  const std::string otto = sign_in("otto");
  for (int i = 0; i < 10; ++i) {
    const HttpResponse response = sign_in_answer("otto", "654321");
    EXPECT_EQ(response.status, i < GuessCounts::kAtOnce ? 401U : 429U) << i;
  }
  const HttpResponse right = sign_in_answer("otto", "123456");
  ASSERT_EQ(right.status, 429U) << "else guessing goes on";
  EXPECT_THAT(right.headers, ::testing::Contains(::testing::Pair("Retry-After", ::testing::Ne("0"))));
  EXPECT_EQ(sign_in_answer("otto", "123456", "198.51.100.1").status, 201U) << "from elsewhere";
  EXPECT_EQ(sign_in_answer("eva", "123456").status, 201U) << "somebody else";
  EXPECT_EQ(status(otto, post("/api/v1/cell/stop")), 202U);
  EXPECT_EQ(role(otto), "operate");
}

TEST_F(PeopleDeskTest, ASessionEndsAtOnceWhenItsUserSignsOutIsChangedOrRemoved) {
  add("otto", "operate");
  std::string otto = sign_in("otto");
  const std::string elsewhere = sign_in("otto");
  EXPECT_EQ(status(otto, post("/api/v1/sign-out", "{}")), 200U);
  EXPECT_EQ(status(otto, post("/api/v1/sign-out", "{}")), 200U) << "a second time changes nothing";
  EXPECT_EQ(role(otto), "none");
  EXPECT_EQ(role(elsewhere), "operate") << "another browser";
  EXPECT_EQ(status(otto, post("/api/v1/cell/stop")), 401U) << "who has signed out is nobody";

  otto = sign_in("otto");
  const HttpResponse demoted = send(post("/api/v1/users", R"({"name":"otto","role":"view"})"));
  ASSERT_EQ(demoted.status, 201U) << demoted.body;
  EXPECT_EQ(role(otto), "none");
  EXPECT_EQ(role(sign_in("otto")), "view") << "the secret stayed";

  otto = sign_in("otto");
  EXPECT_EQ(send(post("/api/v1/users/otto/remove", "{}")).status, 200U);
  EXPECT_EQ(role(otto), "none");
  EXPECT_EQ(sign_in_answer("otto", "123456").status, 401U);
  EXPECT_EQ(send(post("/api/v1/users/otto/remove", "{}")).status, 404U);
}

TEST_F(PeopleDeskTest, ASessionThatIsOverMayStopAndNothingElse) {
  add("otto", "operate");
  const std::string otto = sign_in("otto");
  UserBook book = api_.services().user_book;
  book.sessions.front().ends_at = "1969-12-31T23:00:00.000Z";
  api_.take_users(book);
  const json told = session(otto);
  EXPECT_EQ(told.at("name"), "otto");
  EXPECT_EQ(told.at("kind"), "user");
  EXPECT_EQ(told.at("role"), "none");
  EXPECT_EQ(told.at("ends_at"), nullptr);
  EXPECT_EQ(status(otto, get("/api/v1/status")), 401U);
  EXPECT_EQ(status(otto, post("/api/v1/cell/acknowledge")), 401U);
  EXPECT_EQ(status(otto, post("/api/v1/cell/stop")), 202U);
}

TEST_F(PeopleDeskTest, SomebodyChangesTheirOwnSecretByTheOldOne) {
  add("otto", "operate");
  const std::string otto = sign_in("otto"), elsewhere = sign_in("otto");
  const auto change = [&](const std::string& token, const std::string& old, const std::string& secret) {
    return status(token,
                  post("/api/v1/session/secret", json{{"secret", old}, {"new_secret", secret}}.dump()));
  };
  EXPECT_EQ(change(otto, "654321", "another one"), 401U);
  EXPECT_EQ(change(otto, "123456", "short"), 400U);
  EXPECT_EQ(change(otto, "123456", "another one"), 200U);
  EXPECT_EQ(role(otto), "operate");
  EXPECT_EQ(role(elsewhere), "none");
  EXPECT_EQ(sign_in_answer("otto", "123456").status, 401U);
  EXPECT_EQ(sign_in_answer("otto", "another one").status, 201U);
  EXPECT_EQ(change(kTokens.operate, "123456", "another one"), 409U) << "nobody who signed in";
  EXPECT_EQ(change(std::string(64, '9'), "123456", "another one"), 401U);
}

TEST_F(PeopleDeskTest, WhoIsSignedInIsTheOperator) {
  add("otto", "operate");
  const std::string otto = sign_in("otto");
  const HttpResponse other =
      send(by(otto, post("/api/v1/runs", R"({"recipe":"edf-25","operator":"somebody else"})")));
  EXPECT_EQ(other.status, 400U);
  EXPECT_THAT(other.body, HasSubstr("/operator"));
  send(by(otto, post("/api/v1/runs", R"({"recipe":"edf-25"})")));
  EXPECT_EQ(last_audit().operator_name, "otto");
  add("eva", "engineer");
  EXPECT_EQ(status(sign_in("eva"), post("/api/v1/models/rollback", R"({"operator":"otto"})")), 400U);
}

TEST_F(PeopleDeskTest, UsersAreListedWithoutTheirSecrets) {
  add("otto", "operate");
  add("anna", "engineer");
  sign_in("anna");
  const HttpResponse response = send(by(kTokens.operate, get("/api/v1/users")));
  const json users = json::parse(response.body).at("users");
  ASSERT_THAT(users, SizeIs(2));
  EXPECT_EQ(users[0].at("name"), "anna");
  EXPECT_EQ(users[0].at("session_count"), 1);
  EXPECT_EQ(users[1].at("last_sign_in_at"), nullptr);
  EXPECT_THAT(response.body, Not(HasSubstr("argon2")));
}

TEST_F(PeopleDeskTest, BadBodiesChangeNothing) {
  for (const char* body : {"", "[]", "{}", R"({"name":"otto"})", R"({"name":"otto","role":"operate"})",
                           R"({"name":"otto","role":"owner","secret":"123456"})",
                           R"({"name":" ","role":"operate","secret":"123456"})",
                           R"({"name":"otto","role":"operate","secret":"12345"})",
                           R"({"name":"otto","role":"operate","secret":123456})",
                           R"({"name":"otto","role":"operate","secret":"123456","more":1})"}) {
    const HttpResponse response = send(post("/api/v1/users", body));
    EXPECT_EQ(response.status, 400U) << body;
    EXPECT_THAT(response.body, Not(HasSubstr("12345"))) << "a refusal tells no secret";
  }
  EXPECT_THAT(api_.services().user_book.users, IsEmpty());
}

TEST_F(PeopleDeskTest, AKeyKeepsNoAnswerWithAToken) {
  add("otto", "operate");
  HttpRequest request = keyed("/api/v1/sign-in", "one key", R"({"name":"otto","secret":"123456"})");
  const std::string first = send(request).body, second = send(request).body;
  EXPECT_NE(json::parse(first).at("token"), json::parse(second).at("token"));
}

/// The thread that hashes is stepped by hand, so that others act while a request waits for it.
class SlowHashing : public ::testing::Test {
 protected:
  SlowHashing() {
    add("otto", "operate");
    add("eva", "engineer");
  }
  using Answered = std::shared_ptr<std::optional<HttpResponse>>;

  Answered begin(const std::string& token, const std::string& path, const json& body) {
    requests_.push_back({.method = "POST",
                         .path = path,
                         .authorization = "Bearer " + token,
                         .content_type = "application/json",
                         .body = body.dump(),
                         .remote = "192.0.2.7"});
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
        begin(kTokens.operate, "/api/v1/users", {{"name", name}, {"role", role}, {"secret", "123456"}});
    hash_one();
    ASSERT_EQ(status(added), 201U);
  }
  /// An engineer's word, which needs no hash.
  void change_role(const std::string& name, const std::string& role) {
    ASSERT_EQ(status(begin(kTokens.operate, "/api/v1/users", {{"name", name}, {"role", role}})), 201U);
  }
  std::string sign_in(const std::string& name) {
    const Answered signed_in = begin("", "/api/v1/sign-in", {{"name", name}, {"secret", "123456"}});
    hash_one();
    EXPECT_EQ(status(signed_in), 201U);
    return json::parse(answered_text(signed_in)).value("token", "");
  }
  static unsigned status(const Answered& answered) { return *answered ? (*answered)->status : 0; }
  static std::string answered_text(const Answered& answered) { return *answered ? (*answered)->body : "{}"; }
  std::vector<std::string> users() {
    std::vector<std::string> names;
    for (const User& user : api_.services().user_book.users) names.push_back(user.name);
    return names;
  }

  QuietCell quiet_;
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

TEST_F(SlowHashing, ASecretIsNotChangedByASessionThatHasEndedMeanwhile) {
  const std::string otto = sign_in("otto");
  const Answered changed =
      begin(otto, "/api/v1/session/secret", {{"secret", "123456"}, {"new_secret", "of a thief"}});
  hash_one();  // the old one is right, the new one waits for its hash
  change_role("otto", "view");
  hash_one();
  EXPECT_EQ(status(changed), 401U);
  sign_in("otto");  // by the secret that stayed
}

TEST_F(SlowHashing, NobodySignsInByASecretThatWasWithdrawnMeanwhile) {
  const Answered signed_in = begin("", "/api/v1/sign-in", {{"name", "otto"}, {"secret", "123456"}});
  ASSERT_EQ(status(begin(kTokens.operate, "/api/v1/users/otto/remove", json::object())), 200U);
  hash_one();
  EXPECT_EQ(status(signed_in), 401U);
  EXPECT_THAT(api_.services().user_book.sessions, IsEmpty());
}

TEST_F(SlowHashing, AnEngineerWhoWasRemovedMeanwhileMakesNoUser) {
  const std::string eva = sign_in("eva");
  const Answered added =
      begin(eva, "/api/v1/users", {{"name", "mallory"}, {"role", "engineer"}, {"secret", "123456"}});
  ASSERT_EQ(status(begin(kTokens.operate, "/api/v1/users/eva/remove", json::object())), 200U);
  hash_one();
  EXPECT_EQ(status(added), 401U);
  EXPECT_EQ(users(), std::vector<std::string>{"otto"});
}

}  // namespace
}  // namespace cell
