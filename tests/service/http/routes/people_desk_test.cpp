// Signing in and out, and who may: through the whole API, with real hashes.
#include "service/http/routes/internal/people_desk.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/service/http/routes/people_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

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
  sign_in_answer("271828", "otto");
  EXPECT_EQ(last_audit().token_name, "") << "a name that nobody has may be a secret in the wrong field";
  send(by(otto, post("/api/v1/cell/acknowledge")));
  EXPECT_EQ(last_audit().token_name, "otto");
  send(by(otto, post("/api/v1/session/secret", R"({"secret":"271828","new_secret":"271829"})")));
  send(post("/api/v1/users", R"({"name":"271828","role":"otto","secret":"271828"})"));
  for (const AuditEntry& entry : api_.services().audit.page(100)) {
    for (const std::string* text : {&entry.at, &entry.who, &entry.token_name, &entry.operator_name,
                                    &entry.remote, &entry.action, &entry.outcome, &entry.detail})
      EXPECT_THAT(*text, Not(HasSubstr("27182")));
  }
}

TEST_F(PeopleDeskTest, TheAuditTellsWhomARequestOfAnEngineerWasAbout) {
  add("otto", "operate");
  AuditEntry row = last_audit();
  EXPECT_EQ(row.action, "POST /api/v1/users");
  EXPECT_EQ(row.detail, "user otto, role operate, another secret");
  EXPECT_EQ(row.outcome, "201");
  EXPECT_EQ(api_.services().audit.page(2).at(1).detail, row.detail) << "also before it is taken";
  send(post("/api/v1/users", R"({"name":"otto","role":"view"})"));
  EXPECT_EQ(last_audit().detail, "user otto, role view, the secret stays");
  send(by(sign_in("otto"), post("/api/v1/users", R"({"name":"eva","role":"engineer","secret":"271828"})")));
  row = last_audit();
  EXPECT_EQ(row.outcome, "403");
  EXPECT_EQ(row.detail, "") << "what others send as a name may be anything";
}

TEST_F(PeopleDeskTest, TheLongestNameStandsWholeInTheAuditAndALongerOneIsNobodys) {
  const auto encoded = [](std::size_t characters) {
    std::string text;
    for (std::size_t i = 0; i < characters; ++i) text += "%C3%BC";
    return text;
  };
  std::string name;
  for (int i = 0; i < 32; ++i) name += "ü";
  add(name, "view");
  const std::string path = "/api/v1/users/" + encoded(32) + "/remove";
  EXPECT_EQ(send(post(path, "{}")).status, 200U);
  EXPECT_EQ(last_audit().action, "POST " + path);
  EXPECT_EQ(last_audit().detail, "user " + name);
  const HttpResponse longer = send(post("/api/v1/users/" + encoded(33) + "/remove", "{}"));
  EXPECT_EQ(longer.status, 404U);
  EXPECT_THAT(longer.body, HasSubstr("at most 64 bytes"));
}

TEST_F(PeopleDeskTest, AWrongSecretAndAWrongNameAreRefusedAlike) {
  add("otto", "operate");
  const HttpResponse secret = sign_in_answer("otto", "654321"), name = sign_in_answer("nobody", "271828");
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
  const HttpResponse right = sign_in_answer("otto", "271828");
  ASSERT_EQ(right.status, 429U) << "else guessing goes on";
  EXPECT_THAT(right.headers, ::testing::Contains(::testing::Pair("Retry-After", ::testing::Ne("0"))));
  EXPECT_EQ(sign_in_answer("otto", "271828", "198.51.100.1").status, 201U) << "from elsewhere";
  EXPECT_EQ(sign_in_answer("eva", "271828").status, 201U) << "somebody else";
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
  EXPECT_EQ(sign_in_answer("otto", "271828").status, 401U);
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
  EXPECT_EQ(change(otto, "271828", "short"), 400U);
  EXPECT_EQ(change(otto, "271828", "another one"), 200U);
  EXPECT_EQ(role(otto), "operate");
  EXPECT_EQ(role(elsewhere), "none");
  EXPECT_EQ(sign_in_answer("otto", "271828").status, 401U);
  EXPECT_EQ(sign_in_answer("otto", "another one").status, 201U);
  EXPECT_EQ(change(kTokens.operate, "271828", "another one"), 409U) << "nobody who signed in";
  EXPECT_EQ(change(std::string(64, '9'), "271828", "another one"), 401U);
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
                           R"({"name":"otto","role":"owner","secret":"271828"})",
                           R"({"name":" ","role":"operate","secret":"271828"})",
                           R"({"name":"otto","role":"operate","secret":"12345"})",
                           R"({"name":"otto","role":"operate","secret":"123456"})",
                           R"({"name":"otto","role":"operate","secret":271828})",
                           R"({"name":"otto","role":"operate","secret":"271828","more":1})"}) {
    const HttpResponse response = send(post("/api/v1/users", body));
    EXPECT_EQ(response.status, 400U) << body;
    EXPECT_THAT(response.body, Not(HasSubstr("271828"))) << "a refusal tells no secret";
  }
  EXPECT_THAT(api_.services().user_book.users, IsEmpty());
}

TEST_F(PeopleDeskTest, AKeyKeepsNoAnswerWithAToken) {
  add("otto", "operate");
  HttpRequest request = keyed("/api/v1/sign-in", "one key", R"({"name":"otto","secret":"271828"})");
  const std::string first = send(request).body, second = send(request).body;
  EXPECT_NE(json::parse(first).at("token"), json::parse(second).at("token"));
}

TEST_F(PeopleDeskTest, AUserIsPutAnewWithTheSameKeyAndNothingOfItIsKept) {
  const auto put = [&](const std::string& secret) {
    const json body{{"name", "otto"}, {"role", "operate"}, {"secret", secret}};
    return send(keyed("/api/v1/users", "one key", body.dump())).status;
  };
  EXPECT_EQ(put("271828"), 201U);
  const std::string otto = sign_in("otto");
  EXPECT_EQ(put("314159"), 201U) << "another body is no reuse of the key: no digest of a secret is kept";
  EXPECT_EQ(role(otto), "none") << "it was done again, not answered again";
  EXPECT_EQ(sign_in_answer("otto", "271828").status, 401U);
  EXPECT_EQ(sign_in_answer("otto", "314159").status, 201U);
  EXPECT_EQ(quiet_.store().database()->execAndGet("SELECT count(*) FROM answers").getInt(), 0);
}

TEST_F(SlowHashing, ASecretIsNotChangedByASessionThatHasEndedMeanwhile) {
  const std::string otto = sign_in("otto");
  const Answered changed =
      begin(otto, "/api/v1/session/secret", {{"secret", "271828"}, {"new_secret", "of a thief"}});
  hash_one();  // the old one is right, the new one waits for its hash
  change_role("otto", "view");
  hash_one();
  EXPECT_EQ(status(changed), 401U);
  sign_in("otto");  // by the secret that stayed
}

TEST_F(SlowHashing, NobodySignsInByASecretThatWasWithdrawnMeanwhile) {
  const Answered signed_in = begin("", "/api/v1/sign-in", {{"name", "otto"}, {"secret", "271828"}});
  ASSERT_EQ(status(begin(kTokens.operate, "/api/v1/users/otto/remove", json::object())), 200U);
  hash_one();
  EXPECT_EQ(status(signed_in), 401U);
  EXPECT_THAT(api_.services().user_book.sessions, IsEmpty());
}

TEST_F(SlowHashing, AnEngineerWhoWasRemovedMeanwhileMakesNoUser) {
  const std::string eva = sign_in("eva");
  const Answered added =
      begin(eva, "/api/v1/users", {{"name", "mallory"}, {"role", "engineer"}, {"secret", "271828"}});
  ASSERT_EQ(status(begin(kTokens.operate, "/api/v1/users/eva/remove", json::object())), 200U);
  hash_one();
  EXPECT_EQ(status(added), 401U);
  EXPECT_EQ(users(), std::vector<std::string>{"otto"});
}

}  // namespace
}  // namespace cell
