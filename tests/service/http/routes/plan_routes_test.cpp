#include "service/http/routes/internal/plan_routes.hpp"

#include <gmock/gmock.h>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <nlohmann/json.hpp>

#include "config/file_bytes.hpp"
#include "config/touches_file.hpp"
#include "service/http/routes/api.hpp"
#include "tests/service/http/test_tokens.hpp"
#include "tests/service/quiet_cell.hpp"

namespace cell {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Pair;

constexpr const char* kShippedRecipe = "edf-25";

class PlanRoutes : public ::testing::Test {
 protected:
  static HttpRequest post(const std::string& path, const std::string& body) {
    return {.method = "POST",
            .path = path,
            .authorization = "Bearer " + kTokens.operate,
            .content_type = "application/json",
            .body = body};
  }
  static HttpRequest plan_request(const std::string& body = R"({"recipe":"edf-25"})") {
    return post("/api/v1/plan", body);
  }
  HttpResponse send(const HttpRequest& request) {
    return cell_.run(route(request, cell_.operation(), kTokens));
  }
  [[nodiscard]] std::optional<std::string> to_plan(const HttpRequest& request) {
    return recipe_to_plan(request, cell_.operation());
  }

  void begin_planning() {
    boost::asio::co_spawn(cell_.context(), cell_.operation().plan_recipe(kShippedRecipe),
                          boost::asio::detached);
    cell_.context().poll();
  }
  void finish_planning() { cell_.context().run(); }

  QuietCell cell_;
};

TEST_F(PlanRoutes, APlanIsMadeOnceAndShownFromThenOn) {
  EXPECT_EQ(to_plan(plan_request()), kShippedRecipe);
  begin_planning();
  finish_planning();
  EXPECT_EQ(to_plan(plan_request()), std::nullopt) << "it is there";
  const HttpResponse shown = send(plan_request());
  ASSERT_EQ(shown.status, 200u) << shown.body;
  EXPECT_EQ(json::parse(shown.body).at("schema"), "touchcal/plan/1");
  EXPECT_EQ(send(plan_request()).body, shown.body);

  const std::string id = json::parse(shown.body).at("plan_id");
  const json start = json::parse(send(post("/api/v1/runs", R"({"plan_id":")" + id + "\"}")).body);
  EXPECT_EQ(start.at("status"), 409) << "the plan is known, the cell is not ready: " << start;
  EXPECT_EQ(start.at("errors")[0].at("code"), "controller_not_connected");
}

TEST_F(PlanRoutes, WhoeverAsksWhileThePlanIsMadeGetsTheSameAnswer) {
  Api api(cell_.context().get_executor(), cell_.operation(), kTokens);
  const HttpRequest request = plan_request();
  std::vector<HttpResponse> answers;
  for (int i = 0; i < 3; ++i) {
    boost::asio::co_spawn(cell_.context(), api.answer(request),
                          [&](const std::exception_ptr& failure, HttpResponse answer) {
                            EXPECT_FALSE(failure);
                            answers.push_back(std::move(answer));
                          });
  }
  cell_.context().poll();
  EXPECT_TRUE(answers.empty());
  EXPECT_EQ(send({.method = "GET", .path = "/api/v1/status", .from_loopback = true}).status, 200u)
      << "others are answered meanwhile";
  cell_.context().run();
  ASSERT_EQ(answers.size(), 3u);
  for (const HttpResponse& answer : answers) {
    EXPECT_EQ(answer.status, 200u);
    EXPECT_EQ(answer.body, answers.front().body);
  }
}

TEST_F(PlanRoutes, NothingIsPlannedForABodyThatNamesNoRecipe) {
  for (const char* body : {"", "{}", "[]", R"({"recipe":"edf-99"})", R"({"recipe":1})", R"({"plan_id":"x"})"})
    EXPECT_EQ(to_plan(plan_request(body)), std::nullopt) << body;
}

TEST_F(PlanRoutes, ABadBodyIsToldWithThePlaceThatIsWrong) {
  const auto pointer = [&](const std::string& body, unsigned status) {
    const HttpResponse response = send(plan_request(body));
    EXPECT_EQ(response.status, status) << body;
    return json::parse(response.body).value("pointer", "none");
  };
  EXPECT_EQ(pointer("{}", 400), "/recipe");
  EXPECT_EQ(pointer(R"({"recipe":7})", 400), "/recipe");
  EXPECT_EQ(pointer(R"({"recipe":"edf-25","fit":7})", 400), "/fit");
  EXPECT_EQ(pointer(R"({"recipe":"edf-99"})", 422), "/recipe");
}

TEST_F(PlanRoutes, TheStiffnessOfARequestOutranksTheRecipes) {
  HttpRequest request =
      post("/api/v1/identify",
           read_file_bytes(kSourceDir / "tests/data/table3-exact.touches.json", kTouchesBytesMax));
  const auto model = [&] { return json::parse(send(request).body).at("model"); };
  EXPECT_EQ(model(), json::array()) << "the recipes of the paper say off";
  request.query = {{"stiffness", "on"}};
  EXPECT_EQ(model(), json::array({"compliance2", "compliance3"}));
  request.query = {{"stiffness", "stiff"}};
  EXPECT_EQ(send(request).status, 400u);
  EXPECT_THAT(json::parse(send(request).body).at("detail").get<std::string>(), HasSubstr("on, off nor auto"));
}

TEST_F(PlanRoutes, ATemperatureThatIsNotOfTodayIsAWarningOfTheResult) {
  Cell dated = edf();
  dated.block.temperature_at = std::chrono::system_clock::time_point{} - std::chrono::hours(9);
  QuietCell yesterday(dated);
  const HttpRequest request =
      post("/api/v1/identify",
           read_file_bytes(kSourceDir / "tests/data/table3-exact.touches.json", kTouchesBytesMax));
  const auto warnings = [&](QuietCell& cell) {
    return json::parse(cell.run(route(request, cell.operation(), kTokens)).body).at("warnings").dump();
  };
  EXPECT_THAT(warnings(yesterday),
              HasSubstr("/temperature_at: the block's temperature of 20.0 degrees C is 9.0 h old"));
  EXPECT_THAT(warnings(cell_), ::testing::Not(HasSubstr("/temperature_at")));
}

TEST_F(PlanRoutes, AStartByAPlanThatIsNotKnownSaysHowToGetOne) {
  const HttpResponse response = send(post("/api/v1/runs", R"({"plan_id":"0123456789abcdef"})"));
  EXPECT_EQ(response.status, 404u);
  const json problem = json::parse(response.body);
  EXPECT_EQ(problem.at("pointer"), "/plan_id");
  EXPECT_THAT(problem.at("detail").get<std::string>(), HasSubstr("/api/v1/plan"));
  EXPECT_EQ(send(post("/api/v1/runs", R"({"plan_id":"x","recipe":"edf-25"})")).status, 400u);
}

TEST_F(PlanRoutes, ThePlanOfARunComesFromTheStore) {
  const std::int64_t run = cell_.store().begin_run({.recipe = kShippedRecipe, .started_at = "start"});
  HttpRequest request{
      .method = "GET", .path = "/api/v1/runs/" + std::to_string(run) + "/plan", .from_loopback = true};
  EXPECT_EQ(send(request).status, 409u) << "not planned yet";
  cell_.store().set_plan(run, 3, "id", R"({"schema":"touchcal/plan/1"})");
  EXPECT_EQ(send(request).status, 200u);
  EXPECT_EQ(send(request).body, R"({"schema":"touchcal/plan/1"})");
}

}  // namespace
}  // namespace cell
