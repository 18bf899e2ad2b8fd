// GET /api/v1/setup/questions and POST /api/v1/setup/check: what a form asks, and what it is told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/service/http/routes/api_bench.hpp"
#include "tests/service/http/routes/routes_bench.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;

class SetupRoutes : public RoutesTest {
 protected:
  HttpResponse check(const std::string& body, const std::string& query = "") {
    return post("/api/v1/setup/check" + query, body);
  }
  json checked(const json& answers) {
    json body = answers;
    body["schema"] = "touchcal/setup/1";
    const HttpResponse response = check(body.dump());
    EXPECT_EQ(response.status, 200u) << response.body;
    return json::parse(response.body);
  }
  static std::vector<std::string> pointers(const json& list) {
    std::vector<std::string> found;
    for (const json& entry : list) found.push_back(entry.at("pointer"));
    return found;
  }
  static json question(const json& document, const std::string& pointer) {
    for (const json& each : document.at("questions"))
      if (each.at("pointer") == pointer) return each;
    ADD_FAILURE() << "nobody asks for " << pointer;
    return json::object();
  }
};

TEST_F(SetupRoutes, AskWhatTheDialogueAsks) {
  const HttpResponse response = get("/api/v1/setup/questions");
  ASSERT_EQ(response.status, 200u) << response.body;
  const json document = json::parse(response.body);
  EXPECT_EQ(question(document, "/arm").at("choices"), json({"three-parallel", "tx60", "tx90"}));
  EXPECT_EQ(question(document, "/default_recipe").at("choices"), json({"quick", "best"}));
  const json size = question(document, "/block/size_mm");
  EXPECT_EQ(size.at("kind"), "numbers");
  EXPECT_EQ(size.at("count"), 3);
  EXPECT_EQ(size.at("unit"), "mm");
  EXPECT_EQ(size.at("guessed"), true);
  EXPECT_EQ(question(document, "/park_joints_deg").at("count"), 6);
  EXPECT_EQ(question(document, "/park_joints_deg").at("optional"), true);
  EXPECT_EQ(question(document, "/tools").at("new_entry").at("name"), "tool1");
  EXPECT_EQ(document.at("answers").at("name"), "cell");
}

TEST_F(SetupRoutes, AskInTheLanguageThatIsWanted) {
  const json french = json::parse(get("/api/v1/setup/questions?language=fr").body);
  EXPECT_EQ(french.at("language"), "fr");
  EXPECT_EQ(question(french, "/name").at("prompt"), "Nom de la cellule");
  const std::string body = R"({"schema":"touchcal/setup/1"})";
  EXPECT_EQ(question(json::parse(check(body, "?language=de").body), "/name").at("prompt"), "Name der Zelle");
  EXPECT_EQ(problem(get("/api/v1/setup/questions?language=xx")).at("status"), 400);
  EXPECT_EQ(problem(check(body, "?language=xx")).at("status"), 400);
}

TEST_F(SetupRoutes, TellWhatTheFilesWouldBeAndDrawTheScene) {
  const json good = checked({{"name", "press 3"}});
  EXPECT_EQ(good.at("passes"), true);
  EXPECT_EQ(good.at("refused"), json::array());
  EXPECT_THAT(good.at("scene_svg").get<std::string>(), HasSubstr("<svg"));
  std::vector<std::string> names;
  for (const json& file : good.at("files")) names.push_back(file.at("name"));
  EXPECT_THAT(names, ::testing::IsSupersetOf({"arm.json", "block.json", "cell.json", "setup.json"}));
  EXPECT_EQ(good.at("answers").at("name"), "press 3");
  EXPECT_EQ(question(good, "/name").at("guessed"), false);
}

TEST_F(SetupRoutes, NameEachAnswerThatIsMissingOrRefused) {
  const json wrong = checked(
      {{"name", nullptr}, {"nominal_miss_mm", "NaN"}, {"workspace_box", {{"name", "box"}}}, {"tools", 7}});
  EXPECT_EQ(wrong.at("passes"), false);
  EXPECT_EQ(wrong.at("files"), json::array());
  EXPECT_THAT(pointers(wrong.at("refused")),
              ::testing::UnorderedElementsAre("/name", "/nominal_miss_mm", "/workspace_box", "/tools"));
  for (const json& refused : wrong.at("refused")) EXPECT_NE(refused.at("remedy"), "") << refused;
  EXPECT_THAT(wrong.at("scene_svg").get<std::string>(), HasSubstr("<svg")) << "of what is known";
}

TEST_F(SetupRoutes, TakeNamesInAnyScriptAndOfAnyLength) {
  const std::string right_to_left = "\u05ea\u05d0 \u202e\u0645\u0635\u0646\u0639";
  const json answer = checked(
      {{"name", right_to_left},
       {"block", {{"name", std::string(200, 'b')}}},
       {"workspace_box",
        {{"name", "<script>alert(1)</script>"}, {"min_mm", {-300, -500, -250}}, {"max_mm", {300, 0, 550}}}}});
  EXPECT_EQ(answer.at("answers").at("name"), right_to_left);
  EXPECT_EQ(answer.at("passes"), true) << answer.at("refused");
  EXPECT_EQ(answer.at("scene_svg").get<std::string>().find("<script"), std::string::npos);
}

TEST_F(SetupRoutes, RefuseWhatIsNoSetOfAnswers) {
  for (const char* none : {"", "{}", "[]", "NaN", R"({"schema":"touchcal/cell/3"})",
                           R"({"schema":"touchcal/setup/1","nominal_miss_mm":NaN})",
                           R"({"schema":"touchcal/setup/1","name":"a","name":"b"})"}) {
    const json refused = problem(check(none));
    EXPECT_EQ(refused.at("status"), 400) << none;
    EXPECT_TRUE(refused.contains("pointer")) << none;
  }
  const std::string large =
      R"({"schema":"touchcal/setup/1","name":")" + std::string(kBodyBytesMax, 'a') + "\"}";
  EXPECT_EQ(problem(check(large)).at("status"), 413);
  const std::string deep =
      R"({"schema":"touchcal/setup/1","name":)" + std::string(3000, '[') + std::string(3000, ']') + "}";
  EXPECT_EQ(problem(check(deep)).at("status"), 400);
}

TEST_F(SetupRoutes, ReadNoFileOfTheDaemonsMachine) {
  const json elsewhere = checked({{"arm", {{"file", "/etc/passwd"}}}});
  EXPECT_EQ(elsewhere.at("passes"), nullptr);
  EXPECT_EQ(elsewhere.at("scene_svg"), nullptr);
  EXPECT_EQ(elsewhere.dump().find("root:"), std::string::npos);
  EXPECT_EQ(elsewhere.dump().find("is no JSON"), std::string::npos) << "nor tells whether it is there";
}

TEST_F(ApiTest, AChangeOfASetupFormIsNoCommandAndIsNotWrittenDown) {
  const std::string body = R"({"schema":"touchcal/setup/1"})";
  const std::size_t before = api_.services().audit.page(100).size();
  EXPECT_EQ(send(keyed("/api/v1/setup/check", "one", body)).status, 200u);
  EXPECT_EQ(send(keyed("/api/v1/setup/check", "one", R"({"schema":"touchcal/setup/1","name":"b"})")).status,
            200u)
      << "a key is nothing to it";
  EXPECT_EQ(api_.services().audit.page(100).size(), before);
  quiet_.store().database()->exec("DROP TABLE audit");
  EXPECT_EQ(send(post("/api/v1/setup/check", body)).status, 200u) << "it writes nothing";
}

TEST_F(ApiTest, ASetupFormIsForAnEngineer) {
  HttpRequest request = post("/api/v1/setup/check", R"({"schema":"touchcal/setup/1"})");
  request.authorization = "Bearer " + kTokens.view;
  EXPECT_EQ(send(request).status, 403u);
  request.authorization.reset();
  EXPECT_EQ(send(request).status, 401u);
}

}  // namespace
}  // namespace cell
